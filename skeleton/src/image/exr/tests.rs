use std::io::Cursor;
use std::path::Path;

use ::exr::prelude::{
    AnyChannel, AnyChannels, Blocks, Compression, Encoding, FlatSamples, LayerAttributes, LineOrder,
    ReadChannels, ReadLayers, SmallVec, Vec2, WritableImage, f16, read,
};

use super::read::decode;
use super::{ExrFile, Precision};
use crate::image::Image;
use crate::math::Rgb;

/// Writes and reads a file.
fn round_trip(file: &ExrFile, precision: Precision) -> ExrFile {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("picture.exr");
    file.write(&path, precision).expect("writing works");
    ExrFile::read(&path).expect("reading works")
}

/// The bytes of a written file.
fn bytes_of(file: &ExrFile, precision: Precision) -> Vec<u8> {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("picture.exr");
    file.write(&path, precision).expect("writing works");
    std::fs::read(path).expect("the file is there")
}

/// Reads from memory.
fn decoded(bytes: &[u8]) -> Result<ExrFile, String> {
    decode(Cursor::new(bytes), bytes.len() as u64)
}

/// An image of more than one block of rows, in which all values are different.
fn pattern(width: usize, height: usize, offset: f32) -> Image {
    let value = |i: usize| (i as f32 * 0.37 + offset).sin() * 10.0;
    let pixels = (0..width * height).map(|i| Rgb::new(value(3 * i), value(3 * i + 1), value(3 * i + 2)));
    Image::from_pixels(width, height, pixels.collect())
}

/// The bits of the channels, so that NaNs can be compared.
fn bits(file: &ExrFile) -> Vec<(&String, Vec<u32>)> {
    file.channels.iter().map(|(name, all)| (name, all.iter().map(|x| x.to_bits()).collect())).collect()
}

/// SplitMix64 (Steele, Lea, Flood 2014).
struct Dice(u64);

impl Dice {
    fn roll(&mut self, sides: usize) -> usize {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut mixed = self.0;
        mixed = (mixed ^ (mixed >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        mixed = (mixed ^ (mixed >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((mixed ^ (mixed >> 31)) % sides as u64) as usize
    }
}

#[test]
fn the_same_content_gives_the_same_bytes() {
    // Many entries: a hash table with a random seed would hardly ever hold them in the same order twice.
    let file = (0..16).fold(ExrFile::new(&pattern(16, 40, 0.0)), |file, index| {
        file.with_metadata(format!("arty:entry {index}"), index.to_string())
    });
    let first = bytes_of(&file, Precision::Full);
    for _ in 0..8 {
        assert_eq!(bytes_of(&file, Precision::Full), first);
    }
    assert_eq!(decoded(&first), Ok(file_as_read(&file)));
}

/// The file as it is read back: with the name of the program that wrote it.
fn file_as_read(file: &ExrFile) -> ExrFile {
    let software = concat!(env!("CARGO_PKG_NAME"), " ", env!("CARGO_PKG_VERSION"));
    file.clone().with_metadata("software", software)
}

#[test]
fn layers_and_metadata_survive_a_round_trip() {
    let (picture, variance) = (pattern(7, 37, 0.0), pattern(7, 37, 1.0));
    let file = ExrFile::new(&picture)
        .with_layer("variance", &variance)
        .with_metadata("arty:scene_hash", "0123abcd")
        .with_metadata("arty:a name that is longer than thirty-one bytes", "Grüße, 世界")
        .with_metadata("arty:empty", "")
        .with_metadata("comments", "two\nlines")
        .with_metadata("software", "someone else");
    let read = round_trip(&file, Precision::Full);
    assert_eq!(read, file);
    assert_eq!(read.layer("").as_ref(), Some(&picture));
    assert_eq!(read.layer("variance").as_ref(), Some(&variance));
    assert_eq!(read.layer("albedo"), None);
    let names: Vec<&str> = read.channels.keys().map(String::as_str).collect();
    assert_eq!(names, ["B", "G", "R", "variance.B", "variance.G", "variance.R"]);
}

#[test]
fn files_name_the_program() {
    let read = round_trip(&ExrFile::new(&Image::new(2, 2)), Precision::Full);
    let software = concat!(env!("CARGO_PKG_NAME"), " ", env!("CARGO_PKG_VERSION"));
    assert_eq!(read.metadata.get("software").map(String::as_str), Some(software));
}

#[test]
fn full_precision_keeps_every_bit_of_every_kind_of_float() {
    let special = [
        f32::NAN,
        f32::from_bits(0xffc1_2345),
        f32::from_bits(0x7f80_0001), // a signalling NaN
        f32::INFINITY,
        f32::NEG_INFINITY,
        -0.0,
        f32::from_bits(1),
        -f32::MIN_POSITIVE / 3.0,
        f32::MAX,
        f32::MIN,
        0.1,
        1.0,
    ];
    let mut file = ExrFile { width: 4, height: 3, ..ExrFile::default() };
    file.channels.insert("Y".to_owned(), special.to_vec());
    assert_eq!(bits(&round_trip(&file, Precision::Full)), bits(&file));
}

#[test]
fn incompressible_noise_survives_a_round_trip() {
    let mut dice = Dice(1);
    let mut file = ExrFile { width: 33, height: 50, ..ExrFile::default() };
    for name in ["A", "noise.X"] {
        let samples = (0..33 * 50).map(|_| f32::from_bits(dice.roll(1 << 32) as u32)).collect();
        file.channels.insert(name.to_owned(), samples);
    }
    assert_eq!(bits(&round_trip(&file, Precision::Full)), bits(&file));
}

#[test]
fn half_precision_rounds_and_keeps_finite_values_finite() {
    let mut file = ExrFile { width: 6, height: 1, ..ExrFile::default() };
    let samples = vec![0.1, 1e9, -1e9, f32::INFINITY, f32::NAN, 1.0];
    file.channels.insert("Y".to_owned(), samples);
    let read = round_trip(&file, Precision::Half);
    let read = &read.channels["Y"];
    // Half floats have 11 significant bits.
    assert!((read[0] - 0.1).abs() <= 0.1 / 2048.0);
    assert_eq!(read[1..4], [65504.0, -65504.0, f32::INFINITY]);
    assert!(read[4].is_nan());
    assert_eq!(read[5], 1.0);
    let picture = ExrFile::new(&pattern(64, 64, 0.0));
    assert!(bytes_of(&picture, Precision::Half).len() < bytes_of(&picture, Precision::Full).len() * 2 / 3);
}

#[test]
fn other_readers_find_the_image_and_its_layers() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("picture.exr");
    let (picture, variance) = (pattern(5, 20, 0.0), pattern(5, 20, 1.0));
    let file = ExrFile::new(&picture).with_layer("variance", &variance).with_metadata("arty:seed", "7");
    file.write(&path, Precision::Full).expect("writing works");

    let generic = read()
        .no_deep_data()
        .largest_resolution_level()
        .all_channels()
        .all_layers()
        .all_attributes()
        .pedantic()
        .from_file(&path)
        .expect("a valid file");
    assert_eq!(generic.layer_data.len(), 1);
    let layer = &generic.layer_data[0];
    assert_eq!(layer.size, Vec2(5, 20));
    assert_eq!(layer.encoding.compression, Compression::ZIP16);
    let text = layer.attributes.other.values().next().and_then(|value| value.to_text().ok());
    assert_eq!(text.map(|text| text.to_string()), Some("7".to_owned()));
    let names: Vec<String> = layer.channel_data.list.iter().map(|channel| channel.name.to_string()).collect();
    assert_eq!(names, ["B", "G", "R", "variance.B", "variance.G", "variance.R"]);
    let red: Vec<f32> = layer.channel_data.list[5].sample_data.values_as_f32().collect();
    assert_eq!(red, variance.pixels().iter().map(|pixel| pixel.r).collect::<Vec<f32>>());

    // A viewer without support for layers reads R, G and B.
    let shown = read()
        .no_deep_data()
        .largest_resolution_level()
        .rgb_channels(
            |size, _| Image::new(size.width(), size.height()),
            |image, at, (r, g, b)| {
                image[(at.x(), at.y())] = Rgb::new(r, g, b);
            },
        )
        .first_valid_layer()
        .all_attributes()
        .from_file(&path)
        .expect("a valid file");
    assert_eq!(shown.layer_data.channel_data.pixels, picture);
}

/// A file of 3 x 18 pixels in variants that other programs write.
fn foreign_file(compression: Compression, blocks: Blocks, order: LineOrder) -> Vec<u8> {
    let channels: SmallVec<[AnyChannel<FlatSamples>; 4]> = [
        AnyChannel::new("half", FlatSamples::F16((0..54).map(|i| f16::from_f32(i as f32)).collect())),
        AnyChannel::new("id", FlatSamples::U32((0..54).collect())),
        AnyChannel::new("single", FlatSamples::F32((0..54).map(|i| i as f32 + 0.25).collect())),
    ]
    .into_iter()
    .collect();
    let layer = ::exr::prelude::Layer::new(
        Vec2(3, 18),
        // The data window of a cropped image does not start at 0.
        LayerAttributes::default().with_position(Vec2(-5, 11)),
        Encoding { compression, blocks, line_order: order },
        AnyChannels::sort(channels),
    );
    let mut bytes = Cursor::new(Vec::new());
    ::exr::prelude::Image::from_layer(layer).write().to_buffered(&mut bytes).expect("writing works");
    bytes.into_inner()
}

#[test]
fn scan_lines_of_other_programs_are_read() {
    for compression in [Compression::Uncompressed, Compression::RLE, Compression::ZIP1, Compression::ZIP16] {
        for order in [LineOrder::Increasing, LineOrder::Decreasing] {
            let read = decoded(&foreign_file(compression, Blocks::ScanLines, order)).expect("this is read");
            assert_eq!((read.width, read.height), (3, 18));
            let counted: Vec<f32> = (0..54).map(|i| i as f32).collect();
            assert_eq!(read.channels["half"], counted);
            assert_eq!(read.channels["id"], counted);
            assert!(read.channels["single"].iter().zip(&counted).all(|(a, b)| *a == b + 0.25));
        }
    }
}

#[test]
fn a_cropped_image_is_refused() {
    let channel = AnyChannel::new("R", FlatSamples::F32(vec![1.0; 6]));
    let layer = ::exr::prelude::Layer::new(
        Vec2(3, 2),
        LayerAttributes::default().with_position(Vec2(1, 0)),
        Encoding::UNCOMPRESSED,
        AnyChannels::sort([channel].into_iter().collect()),
    );
    let mut image = ::exr::prelude::Image::from_layer(layer);
    image.attributes.display_window = ::exr::prelude::IntegerBounds::new(Vec2(0, 0), Vec2(8, 4));
    let mut bytes = Cursor::new(Vec::new());
    image.write().to_buffered(&mut bytes).expect("writing works");
    let error = decoded(&bytes.into_inner()).expect_err("it is cropped");
    assert!(error.contains("3 x 2 pixels at (1, 0)") && error.contains("8 x 4 at (0, 0)"), "{error}");
}

#[test]
fn unsupported_formats_are_errors() {
    let tiled = foreign_file(Compression::ZIP16, Blocks::Tiles(Vec2(2, 2)), LineOrder::Increasing);
    assert_eq!(decoded(&tiled), Err("it is tiled or deep; save it as scan lines".to_owned()));
    let piz = foreign_file(Compression::PIZ, Blocks::ScanLines, LineOrder::Increasing);
    let error = decoded(&piz).expect_err("this compression is not supported");
    assert!(error.contains("(piz compression) is not supported"), "{error}");
    for no_image in [b"".as_slice(), b"v/1", b"\x89PNG\r\n\x1a\n and so on"] {
        let error = decoded(no_image).expect_err("this is not an image");
        assert!(error.contains("not an OpenEXR file"), "{error}");
    }
    let error = ExrFile::read(Path::new("no/such/file.exr")).expect_err("there is no such file");
    assert!(error.to_string().starts_with("no/such/file.exr: cannot be read: "), "{error}");
}

/// A small file with several blocks, layers and metadata.
fn small_file() -> ExrFile {
    ExrFile::new(&pattern(9, 40, 0.0))
        .with_layer("variance", &Image::new(9, 40))
        .with_metadata("arty:scene_hash", "0123abcd")
}

#[test]
fn a_truncated_file_is_an_error() {
    let bytes = bytes_of(&small_file(), Precision::Full);
    for length in 0..bytes.len() {
        assert!(decoded(&bytes[..length]).is_err(), "cut off after {length} of {} bytes", bytes.len());
    }
    let longer = [bytes.as_slice(), b"x"].concat();
    assert!(decoded(&longer).is_err(), "something follows the picture");
}

#[test]
fn broken_files_never_cause_a_panic() {
    let originals = [
        bytes_of(&small_file(), Precision::Full),
        bytes_of(&small_file(), Precision::Half),
        foreign_file(Compression::Uncompressed, Blocks::ScanLines, LineOrder::Decreasing),
        foreign_file(Compression::RLE, Blocks::ScanLines, LineOrder::Increasing),
        foreign_file(Compression::ZIP16, Blocks::Tiles(Vec2(2, 2)), LineOrder::Increasing),
    ];
    let telling: [i32; 8] = [0, 1, -1, 255, 1 << 16, 1 << 30, i32::MAX, i32::MIN];
    let mut dice = Dice(2);
    let mut refused = 0;
    const ROUNDS: usize = 2000;
    for original in &originals {
        for _ in 0..ROUNDS {
            let mut bytes = original.clone();
            for _ in 0..=dice.roll(4) {
                // Half of the damage is in the first bytes, which contain sizes and offsets.
                let end = if dice.roll(2) == 0 { bytes.len().min(700) } else { bytes.len() };
                let place = dice.roll(end - 4);
                match dice.roll(3) {
                    0 => bytes[place] ^= 1 << dice.roll(8),
                    1 => bytes[place] = dice.roll(256) as u8,
                    _ => bytes[place..place + 4].copy_from_slice(&telling[dice.roll(8)].to_le_bytes()),
                }
            }
            refused += usize::from(decoded(&bytes).is_err());
        }
    }
    // Damage to sample values cannot be detected, but most of the damage should be.
    assert!(refused > originals.len() * ROUNDS / 2, "only {refused} were refused");
}

/// Replaces the value of an attribute by one of the same length.
fn with_attribute(bytes: &[u8], name: &str, kind: &str, value: &[u8]) -> Vec<u8> {
    let start =
        [name.as_bytes(), b"\0", kind.as_bytes(), b"\0", &(value.len() as i32).to_le_bytes()].concat();
    let place =
        bytes.windows(start.len()).position(|window| window == start).expect("the attribute is there");
    let mut changed = bytes.to_vec();
    changed[place + start.len()..][..value.len()].copy_from_slice(value);
    changed
}

#[test]
fn a_header_that_claims_a_huge_image_is_refused_before_memory_is_allocated() {
    let bytes = bytes_of(&small_file(), Precision::Full);
    let claimed = |width: i32, height: i32| {
        let window: Vec<u8> = [0, 0, width - 1, height - 1].iter().flat_map(|x| x.to_le_bytes()).collect();
        let bytes = with_attribute(&bytes, "dataWindow", "box2i", &window);
        decoded(&bytes).expect_err("this is not the size of the image")
    };
    assert!(claimed(1 << 29, 1 << 29).contains("exceed the limit of 268435456 samples"));
    assert!(claimed(1 << 29, 1).contains("exceed the limit of 268435456 samples"));
    // A gigabyte is within the limit, but not for a file of a few thousand bytes.
    assert!(claimed(6000, 6000).contains("too many for"));
    let error = decode(Cursor::new(&bytes), 1 << 40).expect_err("this is far too long");
    assert!(error.contains("at most"), "{error}");
}

#[test]
fn a_file_with_duplicate_rows_is_refused() {
    let bytes = foreign_file(Compression::Uncompressed, Blocks::ScanLines, LineOrder::Increasing);
    // Each of the 18 rows is a block at the end of the file: its number, its length, and 3 pixels of 10 bytes.
    let last = bytes.len() - (4 + 4 + 30);
    let mut twice = bytes.clone();
    twice[last..last + 4].copy_from_slice(&11_i32.to_le_bytes());
    assert!(decoded(&bytes).is_ok());
    assert_eq!(decoded(&twice), Err("it contains row 0 twice".to_owned()));
}

#[test]
fn what_the_format_cannot_represent_is_an_error_and_keeps_the_earlier_file() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("picture.exr");
    std::fs::write(&path, "earlier").expect("writing works");
    let good = || ExrFile::new(&Image::new(2, 3));
    let with_channel = |name: &str, count: usize| {
        let mut file = good();
        file.channels.insert(name.to_owned(), vec![0.0; count]);
        file
    };
    let cases = [
        (ExrFile::new(&Image::new(0, 3)), "0 x 3 pixels are not supported"),
        (ExrFile { width: 1, height: 1, ..ExrFile::default() }, "there are no channels"),
        (with_channel("Z", 5), "channel Z has 5 samples for 2 x 3 pixels"),
        (with_channel("", 6), "invalid name \"\""),
        (with_channel("a\0b", 6), "invalid name \"a\\0b\""),
        (with_channel(&"x".repeat(256), 6), "invalid name"),
        (good().with_metadata("channels", "none"), "the attribute name channels is reserved"),
        (good().with_metadata("", "none"), "invalid name \"\""),
    ];
    for (file, reason) in cases {
        let error = file.write(&path, Precision::Full).expect_err("the format cannot represent this");
        assert_eq!(error.file, path);
        assert!(error.message.contains(reason), "{error}");
        assert_eq!(std::fs::read(&path).expect("the file is there"), b"earlier");
    }
    good().write(&path, Precision::Full).expect("this is fine");
    assert!(ExrFile::read(&path).is_ok());
}

#[test]
fn a_missing_folder_is_named() {
    let error = ExrFile::new(&Image::new(1, 1)).write(Path::new("no/such/folder/x.exr"), Precision::Full);
    let error = error.expect_err("there is no such folder");
    assert!(error.message.contains("no such folder: no/such/folder"), "{error}");
}
