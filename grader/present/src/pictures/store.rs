//! Pictures as a file, so that a page can be made again with new points of a tutor, without rendering.

use std::io::{Read, Write};
use std::path::Path;

use flate2::Compression;
use flate2::read::ZlibDecoder;
use flate2::write::ZlibEncoder;

use verdict::error::{Error, Result};
use verdict::pictures::Picture;

/// Maximum number of bytes that are read: pictures take two megabytes.
const LARGEST: u64 = 64 << 20;

/// Writes pictures.
///
/// # Errors
/// If the file cannot be written.
pub fn save(pictures: &[Picture], path: &Path) -> Result<()> {
    let bytes = postcard::to_stdvec(pictures).map_err(|error| Error::file(path, error))?;
    arty::image::write_aside(path, |file| {
        let mut encoder = ZlibEncoder::new(file, Compression::fast());
        encoder.write_all(&bytes)?;
        encoder.finish().map(|_| ())
    })
    .map_err(|error| Error::Output(error.to_string()))
}

/// Reads what [`save`] has written; `None` if it is not there or another version's.
pub fn load(path: &Path) -> Option<Vec<Picture>> {
    let mut bytes = Vec::new();
    let file = std::fs::File::open(path).ok()?;
    ZlibDecoder::new(file).take(LARGEST).read_to_end(&mut bytes).ok()?;
    postcard::from_bytes(&bytes).ok()
}

#[cfg(test)]
mod tests {
    use super::*;
    use verdict::sample::picture;

    #[test]
    fn what_is_saved_is_read_again_and_what_is_cut_off_is_not() {
        let folder = tempfile::tempdir().expect("a temporary folder");
        let path = folder.path().join("pictures.bin");
        let pictures = vec![picture("a scene"), picture("another")];
        save(&pictures, &path).expect("it can be written");
        assert_eq!(load(&path), Some(pictures));
        let bytes = std::fs::read(&path).expect("it is there");
        std::fs::write(&path, &bytes[..bytes.len() / 2]).expect("it can be written");
        assert_eq!(load(&path), None);
    }
}
