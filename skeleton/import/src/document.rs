//! A glTF file with its buffers and images.

use std::path::{Component, Path, PathBuf};

use arty::diagnostic::Diagnostic;
use base64::Engine as _;
use base64::engine::general_purpose::STANDARD;
use gltf::buffer::{Source as BufferSource, View};
use gltf::image::Source as ImageSource;
use gltf::json::camera::Type as CameraType;
use gltf::json::validation::Checked;

/// Maximum size of a file: larger than what Blender exports for a scene that can be rendered here.
const MAX_BYTES: u64 = 1 << 30;

/// A glTF file whose buffers have been read.
pub(crate) struct Document {
    path: PathBuf,
    pub(crate) gltf: gltf::Document,
    /// The contents of each buffer.
    buffers: Vec<Vec<u8>>,
}

impl Document {
    /// Reads a `.glb` file, or a `.gltf` file with the files it refers to.
    ///
    /// # Errors
    /// The file, and its first item that is not valid.
    pub(crate) fn read(path: &Path) -> Result<Self, Diagnostic> {
        let bytes = read(path)?;
        let file =
            gltf::Gltf::from_slice_without_validation(&bytes).map_err(|error| not_valid(path, error))?;
        let mut binary = file.blob;
        let json = file.document.into_json();
        if let Some((item, problem)) = not_validated(&json) {
            return Err(Diagnostic::about(path, format!("{item}: {problem}")));
        }
        let gltf = gltf::Document::from_json(json).map_err(|error| not_valid(path, error))?;
        let mut buffers = Vec::new();
        for buffer in gltf.buffers() {
            let item = format!("buffer {}", buffer.index());
            let mut contents = match buffer.source() {
                BufferSource::Bin => binary.take().ok_or_else(|| {
                    Diagnostic::about(path, format!("{item} is missing: the file has no binary part"))
                })?,
                BufferSource::Uri(uri) => resource(path, uri, &item)?,
            };
            if contents.len() < buffer.length() {
                let message = format!("{item} has {} bytes instead of {}", contents.len(), buffer.length());
                return Err(Diagnostic::about(path, message));
            }
            // A binary part is padded to a multiple of four bytes.
            contents.truncate(buffer.length());
            buffers.push(contents);
        }
        Ok(Self { path: path.to_owned(), gltf, buffers })
    }

    /// An error about an item of the file.
    pub(crate) fn error(&self, item: &str, problem: impl std::fmt::Display) -> Diagnostic {
        Diagnostic::about(&self.path, format!("{item}: {problem}"))
    }

    /// The bytes of a view; `None` if it exceeds its buffer.
    pub(crate) fn view(&self, view: &View<'_>) -> Option<&[u8]> {
        let end = view.offset().checked_add(view.length())?;
        self.buffers.get(view.buffer().index())?.get(view.offset()..end)
    }

    /// The file of an image, as PNG or JPEG.
    ///
    /// # Errors
    /// If it cannot be read.
    pub(crate) fn image(&self, image: &gltf::Image<'_>) -> Result<Vec<u8>, Diagnostic> {
        let item = named("image", image.name(), image.index());
        match image.source() {
            ImageSource::View { view, .. } => match self.view(&view) {
                Some(bytes) => Ok(bytes.to_owned()),
                None => Err(self.error(&item, "it exceeds its buffer")),
            },
            ImageSource::Uri { uri, .. } => resource(&self.path, uri, &item),
        }
    }
}

/// "mesh `Cube`", or "mesh 3" where it has no name.
pub(crate) fn named(kind: &str, name: Option<&str>, index: usize) -> String {
    match name {
        Some(name) => format!("{kind} `{}`", printable(name)),
        None => format!("{kind} {index}"),
    }
}

/// A name without what could command a terminal.
fn printable(name: &str) -> String {
    name.chars().map(|letter| if letter.is_control() { '\u{fffd}' } else { letter }).collect()
}

/// The first item that the validation of `gltf` overlooks, or panics at.
fn not_validated(json: &gltf::json::Root) -> Option<(String, &'static str)> {
    let meshes = json.meshes.iter().enumerate();
    let of_mesh = meshes.map(|(index, mesh)| (named("mesh", mesh.name.as_deref(), index), mesh));
    let mut with_missing = of_mesh.filter(|(_, mesh)| {
        let mut accessors = mesh.primitives.iter().flat_map(|primitive| primitive.attributes.values());
        accessors.any(|accessor| accessor.value() >= json.accessors.len())
    });
    if let Some((item, _)) = with_missing.next() {
        return Some((item, "it refers to an accessor that does not exist"));
    }
    let mut images = json.images.iter().enumerate().filter(|(_, image)| match image.buffer_view {
        Some(_) => image.mime_type.is_none(),
        None => image.uri.is_none(),
    });
    if let Some((index, image)) = images.next() {
        return Some((named("image", image.name.as_deref(), index), "it has no data or no MIME type"));
    }
    let mut cameras = json.cameras.iter().enumerate().filter(|(_, camera)| match camera.type_ {
        Checked::Valid(CameraType::Perspective) => camera.perspective.is_none(),
        Checked::Valid(CameraType::Orthographic) => camera.orthographic.is_none(),
        Checked::Invalid => false,
    });
    let (index, camera) = cameras.next()?;
    Some((named("camera", camera.name.as_deref(), index), "it has no field of view"))
}

fn not_valid(path: &Path, error: gltf::Error) -> Diagnostic {
    let message = match error {
        gltf::Error::Validation(problems) => match problems.first() {
            Some((place, problem)) => format!("{place}: {problem}"),
            None => "is not valid".to_owned(),
        },
        other => format!("is not a glTF file: {other}"),
    };
    Diagnostic::about(path, message)
}

fn read(path: &Path) -> Result<Vec<u8>, Diagnostic> {
    let unreadable = |error: std::io::Error| Diagnostic::about(path, format!("cannot be read: {error}"));
    let metadata = std::fs::metadata(path).map_err(unreadable)?;
    if !metadata.is_file() {
        return Err(Diagnostic::about(path, "is not a regular file"));
    }
    if metadata.len() > MAX_BYTES {
        let message = format!("has {} bytes; at most {MAX_BYTES} are read", metadata.len());
        return Err(Diagnostic::about(path, message));
    }
    std::fs::read(path).map_err(unreadable)
}

/// What a URI in `file` names: data in the URI itself, or a file in the same folder or one below.
fn resource(file: &Path, uri: &str, item: &str) -> Result<Vec<u8>, Diagnostic> {
    let error = |problem: &str| Diagnostic::about(file, format!("{item}: {problem}"));
    if let Some(data) = uri.strip_prefix("data:") {
        let encoded = data.split_once(";base64,").ok_or_else(|| error("its data are not in base64"))?.1;
        return STANDARD.decode(encoded).map_err(|problem| error(&format!("its data are broken: {problem}")));
    }
    let name =
        decoded(uri).ok_or_else(|| error("its file name has a `%` that is not followed by two digits"))?;
    let path = Path::new(&name);
    let is_below = path.components().all(|part| matches!(part, Component::Normal(_) | Component::CurDir));
    if uri.contains("://") || !is_below {
        return Err(error(&format!("`{}` is not a file below the folder of the file", printable(&name))));
    }
    let path = file.parent().unwrap_or(Path::new("")).join(path);
    read(&path).map_err(|problem| Diagnostic {
        message: format!("{} ({item} of {})", problem.message, file.display()),
        ..problem
    })
}

/// A URI whose `%20` and the like are replaced by what they stand for.
fn decoded(uri: &str) -> Option<String> {
    let mut bytes = Vec::new();
    let mut rest = uri.bytes();
    while let Some(byte) = rest.next() {
        bytes.push(match byte {
            b'%' => {
                let mut digit = || char::from(rest.next()?).to_digit(16);
                (digit()? * 16 + digit()?) as u8
            }
            other => other,
        });
    }
    String::from_utf8(bytes).ok()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn percent_signs_are_decoded() {
        assert_eq!(decoded("a%20b%C3%A4.bin").as_deref(), Some("a bä.bin"));
        for broken in ["a%", "a%2", "a%zz", "%ff"] {
            assert_eq!(decoded(broken), None, "{broken}");
        }
    }
}
