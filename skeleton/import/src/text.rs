//! Scene, OBJ and MTL files as text. Numbers are written such that they are read back exactly.

use std::fmt::Write;

use arty::scene::LightDescription;

use crate::camera::View;
use crate::material::{Lobes, Material};
use crate::mesh::Part;

/// The scene file.
pub(crate) fn scene(stem: &str, source: &str, view: &View, lights: &[LightDescription]) -> String {
    let camera = &view.camera;
    let [width, height] = view.size;
    let mut text = format!(
        "# Imported from {source} (cargo arty import).\nmeshes: ['{}.obj']\ncamera: !perspective_camera {{ eye: {}, \
         center: {}, up: {}, fov: {:?} }}\n",
        stem.replace('\'', "''"),
        vector(camera.eye.to_array()),
        vector(camera.center.to_array()),
        vector(camera.up.to_array()),
        camera.fov,
    );
    if !lights.is_empty() {
        text.push_str("lights:\n");
    }
    for light in lights {
        let line = match light {
            LightDescription::Point { position, power } => {
                let (position, color) = (vector(position.to_array()), vector(power.to_array()));
                format!("!point_light {{ position: {position}, color: {color} }}")
            }
            LightDescription::Spot { position, direction, inner, outer, power } => format!(
                "!spot_light {{ position: {}, direction: {}, inner: {inner:?}, outer: {outer:?}, color: {} }}",
                vector(position.to_array()),
                vector(direction.to_array()),
                vector(power.to_array())
            ),
            LightDescription::Triangle { vertices: [a, b, c], radiance } => format!(
                "!triangle_light {{ v0: {}, v1: {}, v2: {}, color: {} }}",
                vector(a.to_array()),
                vector(b.to_array()),
                vector(c.to_array()),
                vector(radiance.to_array())
            ),
        };
        let _ = writeln!(text, "  - {line}");
    }
    let _ = writeln!(text, "defaults: {{ width: {width}, height: {height} }}");
    text
}

/// The OBJ file.
pub(crate) fn obj(stem: &str, parts: &[Part], materials: &[Material]) -> String {
    let mut text = format!("mtllib {stem}.mtl\n");
    // Indices start at 1.
    let (mut position, mut normal, mut uv) = (1, 1, 1);
    for part in parts {
        let _ = writeln!(text, "\n# {}", part.title);
        lines(&mut text, "v", &part.positions);
        lines(&mut text, "vt", &part.uvs);
        lines(&mut text, "vn", &part.normals);
        let _ = writeln!(text, "usemtl {}", materials[part.material].name);
        for triangle in &part.triangles {
            text.push('f');
            for &corner in triangle {
                let (at, uv, normal) = (position + corner, uv + corner, normal + corner);
                // Writing to a string cannot fail.
                let _ = match (part.uvs.is_empty(), part.normals.is_empty()) {
                    (true, true) => write!(text, " {at}"),
                    (false, true) => write!(text, " {at}/{uv}"),
                    (true, false) => write!(text, " {at}//{normal}"),
                    (false, false) => write!(text, " {at}/{uv}/{normal}"),
                };
            }
            text.push('\n');
        }
        position += part.positions.len() as u32;
        normal += part.normals.len() as u32;
        uv += part.uvs.len() as u32;
    }
    text
}

/// The MTL file.
pub(crate) fn mtl(materials: &[Material]) -> String {
    let mut text = String::new();
    for Material { name, lobes, emission, texture } in materials {
        let _ = writeln!(text, "newmtl {name}");
        let mut color = |keyword: &str, value: &[f32; 3]| lines(&mut text, keyword, &[*value]);
        match lobes {
            Lobes::Opaque { diffuse, specular, .. } | Lobes::Mirror { diffuse, specular } => {
                color("Kd", diffuse);
                color("Ks", specular);
            }
            Lobes::Glass { transmittance, .. } => color("Tf", transmittance),
        }
        if *emission != [0.0; 3] {
            color("Ke", emission);
        }
        let _ = match lobes {
            Lobes::Opaque { exponent, .. } => writeln!(text, "Ns {exponent:?}\nillum 2"),
            Lobes::Mirror { diffuse: [0.0, 0.0, 0.0], .. } => writeln!(text, "illum 5"),
            Lobes::Mirror { .. } => writeln!(text, "illum 3"),
            Lobes::Glass { index, .. } => writeln!(text, "Ni {index:?}\nillum 7"),
        };
        if let Some((image, _)) = texture {
            let _ = writeln!(text, "map_Kd {image}");
        }
        text.push('\n');
    }
    text
}

fn lines<const N: usize>(text: &mut String, keyword: &str, values: &[[f32; N]]) {
    for value in values {
        text.push_str(keyword);
        for number in value {
            let _ = write!(text, " {number:?}");
        }
        text.push('\n');
    }
}

fn vector([x, y, z]: [f32; 3]) -> String {
    format!("[{x:?}, {y:?}, {z:?}]")
}
