//! placeholder
use crate::math::Vec3;
pub fn point_on(t: &[Vec3; 3], b: [f32; 2]) -> Vec3 {
    let [a, p, q] = t.map(Vec3::as_dvec3);
    (a + f64::from(b[0]) * (p - a) + f64::from(b[1]) * (q - a)).as_vec3()
}
pub struct TriangleHit {
    pub t: f32,
    pub primitive: u32,
    pub barycentrics: [f32; 2],
}
pub fn offset_origin(p: Vec3, n: Vec3, d: Vec3) -> Vec3 {
    p + n * (1e-5f32).copysign(n.dot(d))
}
pub struct Accel {
    t: Vec<[Vec3; 3]>,
}
pub struct AccelStats {
    pub nodes: usize,
    pub duplicates: usize,
}
impl Accel {
    pub fn build(t: &[[Vec3; 3]]) -> Self {
        Self { t: t.to_vec() }
    }
    pub fn stats(&self) -> AccelStats {
        AccelStats { nodes: 0, duplicates: 0 }
    }
    #[inline(never)]
    pub fn intersect(&self, o: Vec3, d: Vec3, t_max: f32) -> Option<TriangleHit> {
        let mut best = None;
        let mut tm = t_max;
        for (i, [a, b, c]) in self.t.iter().enumerate() {
            let (e1, e2) = (*b - *a, *c - *a);
            let p = d.cross(e2);
            let det = e1.dot(p);
            if det == 0.0 {
                continue;
            }
            let s = o - *a;
            let u = s.dot(p) / det;
            if !(0.0..=1.0).contains(&u) {
                continue;
            }
            let q = s.cross(e1);
            let v = d.dot(q) / det;
            if v < 0.0 || u + v > 1.0 {
                continue;
            }
            let t = e2.dot(q) / det;
            if t > 0.0 && t < tm {
                tm = t;
                best = Some(TriangleHit { t, primitive: i as u32, barycentrics: [u, v] })
            }
        }
        best
    }
    #[inline(never)]
    pub fn occluded(&self, o: Vec3, p: Vec3) -> bool {
        self.intersect(o, p - o, 0.9999).is_some()
    }
}
