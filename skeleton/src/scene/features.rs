//! Features of a scene.

use std::fmt;

/// What a scene contains. Determined once, when the scene is built; the renderer skips what the scene does not need, and
/// the grader plans only checks that are meaningful for it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Features {
    /// Number of triangles that rays can hit, including lights.
    pub triangles: usize,
    /// Number of lights with an area, which paths can hit.
    pub area_lights: usize,
    /// Number of lights without an area: point and spot lights.
    pub point_lights: usize,
    /// True if light arrives from outside of the scene.
    pub environment: bool,
    /// Number of triangles with a delta lobe: mirror or glass.
    pub delta_surfaces: usize,
    /// Number of triangles with a Phong lobe.
    pub glossy_surfaces: usize,
    /// Number of triangles where next event estimation applies: with a diffuse or Phong lobe.
    pub lit_surfaces: usize,
    /// Number of triangles with a texture.
    pub textured_surfaces: usize,
    /// Number of triangles with interpolated normals.
    pub smooth_surfaces: usize,
    /// True if closed surfaces enclose the camera, so that no path can leave the scene.
    pub closed: bool,
    /// True if the acceleration structure has a hierarchy; a few triangles are tested one by one.
    pub hierarchy: bool,
}

impl Features {
    /// True if there is at least one light, not counting the environment.
    pub fn has_lights(&self) -> bool {
        self.area_lights + self.point_lights > 0
    }
}

impl fmt::Display for Features {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let count = |n: usize, without: &str| if n == 0 { format!("0  ({without})") } else { n.to_string() };
        writeln!(f, "triangles          {}", count(self.triangles, "rays hit nothing"))?;
        writeln!(f, "area lights        {}", count(self.area_lights, "paths never hit a light"))?;
        writeln!(f, "point lights       {}", count(self.point_lights, "paths can hit every light"))?;
        writeln!(
            f,
            "environment        {}",
            if self.environment { "yes" } else { "no  (rays that leave the scene find no light)" }
        )?;
        writeln!(f, "delta surfaces     {}", count(self.delta_surfaces, "no mirror or glass"))?;
        writeln!(f, "glossy surfaces    {}", count(self.glossy_surfaces, "no Phong lobes"))?;
        writeln!(
            f,
            "lit surfaces       {}",
            count(self.lit_surfaces, "next event estimation does not apply")
        )?;
        writeln!(f, "textured surfaces  {}", count(self.textured_surfaces, "texture lookup is skipped"))?;
        writeln!(f, "smooth surfaces    {}", count(self.smooth_surfaces, "normal interpolation is skipped"))?;
        writeln!(
            f,
            "closed             {}",
            if self.closed { "yes" } else { "no  (paths can leave the scene)" }
        )?;
        write!(
            f,
            "hierarchy          {}",
            if self.hierarchy { "yes" } else { "no  (few triangles, tested one by one)" }
        )
    }
}
