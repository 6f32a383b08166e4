//! What a scene has, and so what it needs.

use std::fmt;

/// What there is in a scene. Worked out once, when it is loaded; the renderer leaves out what the scene does not
/// need, and the grader plans only the checks that mean something in it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Features {
    /// Triangles that rays can hit, those of lights included.
    pub triangles: usize,
    /// Lights that paths can hit by chance.
    pub area_lights: usize,
    /// Lights without an area: point and spot lights.
    pub point_lights: usize,
    /// Surfaces of mirror or glass (triangles).
    pub delta_surfaces: usize,
    /// Surfaces with a Phong lobe (triangles).
    pub glossy_surfaces: usize,
    /// Surfaces on which next event estimation has something to do: not black, not of delta lobes alone.
    pub lit_surfaces: usize,
    /// Surfaces with a texture (triangles).
    pub textured_surfaces: usize,
    /// Surfaces with interpolated normals (triangles).
    pub smooth_surfaces: usize,
    /// True if the camera is enclosed by surfaces without a hole, so that no light can get lost.
    pub closed: bool,
    /// True if there are more triangles than are tested one after the other, without a hierarchy.
    pub hierarchy: bool,
}

impl Features {
    /// True if there is any light at all.
    pub fn has_lights(&self) -> bool {
        self.area_lights + self.point_lights > 0
    }
}

impl fmt::Display for Features {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let count = |n: usize, without: &str| if n == 0 { format!("0  ({without})") } else { n.to_string() };
        writeln!(f, "triangles          {}", count(self.triangles, "nothing to hit"))?;
        writeln!(f, "lights with area   {}", count(self.area_lights, "paths never hit a light by chance"))?;
        writeln!(f, "point-like lights  {}", count(self.point_lights, "every light can be hit by chance"))?;
        writeln!(f, "delta surfaces     {}", count(self.delta_surfaces, "no mirror, no glass"))?;
        writeln!(f, "glossy surfaces    {}", count(self.glossy_surfaces, "no Phong lobes"))?;
        writeln!(
            f,
            "lit surfaces       {}",
            count(self.lit_surfaces, "next event estimation has nothing to do")
        )?;
        writeln!(f, "textured surfaces  {}", count(self.textured_surfaces, "texture look-ups left out"))?;
        writeln!(
            f,
            "smooth surfaces    {}",
            count(self.smooth_surfaces, "interpolation of normals left out")
        )?;
        writeln!(
            f,
            "closed             {}",
            if self.closed { "yes" } else { "no  (paths can leave the scene)" }
        )?;
        write!(
            f,
            "hierarchy          {}",
            if self.hierarchy { "yes" } else { "no  (few triangles: tested in turn)" }
        )
    }
}
