//! The shape of a linked program: whatever decides what runs before `main`, and which symbols it imports and exports.
//!
//! Safe Rust cannot change it. So a program whose shape differs from that of an empty submission is not run. The sandbox
//! does not depend on this.

use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;

use object::Endianness;
use object::elf::{self, FileHeader64};
use object::read::elf::{Dyn, FileHeader, ProgramHeader, SectionHeader, Sym};

use verdict::error::{Error, Result};

/// The shape of a program.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub(crate) struct Shape {
    /// Sizes of all sections, in bytes.
    sections: BTreeMap<String, u64>,
    /// Path of the dynamic loader.
    loader: Vec<u8>,
    /// Kinds of entries in the dynamic section, such as initializers and search paths.
    dynamic: BTreeSet<String>,
    /// Shared libraries.
    libraries: BTreeSet<String>,
    /// Symbols imported from shared libraries.
    imports: BTreeSet<String>,
    /// Symbols exported to shared libraries.
    exports: BTreeSet<String>,
    /// All global symbols that are defined.
    defined: BTreeSet<String>,
    /// Number of relocations and symbols that call a function while the program is loaded.
    resolvers: usize,
    /// True if the first instruction is that of the C library's entry point.
    starts_as_usual: bool,
    /// True if some memory is both writable and executable.
    writes_code: bool,
}

/// Sections of code that runs before or after `main`, and of the loader's name: they must have their usual size.
const FIXED: [&str; 8] =
    [".init", ".fini", ".init_array", ".fini_array", ".preinit_array", ".ctors", ".dtors", ".interp"];

/// Sections of code and data, some of which a small program may lack.
const ORDINARY: [&str; 12] = [
    ".text",
    ".rodata",
    ".data",
    ".bss",
    ".tdata",
    ".tbss",
    ".data.rel.ro",
    ".gcc_except_table",
    ".eh_frame",
    ".eh_frame_hdr",
    ".plt",
    ".relro_padding",
];

/// Maximum size of a program in bytes, far more than any submission needs.
const LARGEST: u64 = 256 << 20;

impl Shape {
    /// Reads the shape of a program.
    ///
    /// # Errors
    /// If the file cannot be read or is not a program.
    pub(crate) fn of(program: &Path) -> Result<Self> {
        let trouble = |why: &dyn std::fmt::Display| Error::Harness(format!("the linked program: {why}"));
        let length = std::fs::metadata(program).map_err(|error| trouble(&error))?.len();
        if length > LARGEST {
            return Err(trouble(&format_args!("{length} bytes are too many")));
        }
        let bytes = std::fs::read(program).map_err(|error| trouble(&error))?;
        Self::read(&bytes).map_err(|error| trouble(&error))
    }

    fn read(bytes: &[u8]) -> object::Result<Self> {
        let header = FileHeader64::<Endianness>::parse(bytes)?;
        let endian = header.endian()?;
        let sections = header.sections(endian, bytes)?;
        let text = |bytes: &[u8]| String::from_utf8_lossy(bytes).into_owned();
        let mut shape = Self::default();
        for section in sections.iter() {
            let name = text(sections.section_name(endian, section)?);
            *shape.sections.entry(name).or_default() += section.sh_size(endian);
            if let Some((relocations, _)) = section.rela(endian, bytes)? {
                let resolves = |rela: &&elf::Rela64<Endianness>| is_resolver(rela.r_type(endian, false).0);
                shape.resolvers += relocations.iter().filter(resolves).count();
            }
        }
        for segment in header.program_headers(endian, bytes)? {
            let flags = segment.p_flags(endian).0;
            shape.writes_code |= flags & elf::PF_W.0 != 0 && flags & elf::PF_X.0 != 0;
            if segment.p_type(endian) == elf::PT_INTERP {
                shape.loader = segment.data(endian, bytes).unwrap_or_default().to_vec();
            }
        }
        if let Some((entries, strings)) = sections.dynamic(endian, bytes)? {
            let strings = sections.strings(endian, bytes, strings)?;
            for entry in entries {
                let tag = entry.d_tag(endian);
                shape.dynamic.insert(format!("{tag:?}"));
                if tag == elf::DT_NEEDED {
                    let name =
                        u32::try_from(entry.d_val(endian)).ok().and_then(|start| strings.get(start).ok());
                    shape.libraries.insert(text(name.unwrap_or_default()));
                }
            }
        }
        let dynamic = sections.symbols(endian, bytes, elf::SHT_DYNSYM)?;
        for symbol in dynamic.iter().filter(|symbol| !symbol.is_local()) {
            let name = text(symbol.name(endian, dynamic.strings())?);
            if symbol.is_undefined(endian) { &mut shape.imports } else { &mut shape.exports }.insert(name);
        }
        let all = sections.symbols(endian, bytes, elf::SHT_SYMTAB)?;
        for symbol in all.iter().filter(|symbol| !symbol.is_undefined(endian)) {
            let name = text(symbol.name(endian, all.strings())?);
            shape.resolvers += usize::from(symbol.st_type() == elf::STT_GNU_IFUNC);
            shape.starts_as_usual |= name == "_start" && symbol.st_value(endian) == header.e_entry(endian);
            // Version scripts make local what was global: both kinds can take another's place.
            shape.defined.insert(name);
        }
        Ok(shape)
    }

    /// Differences from the program of an empty submission; empty if there are none that matter.
    pub(crate) fn differences(&self, usual: &Self) -> Vec<String> {
        let mut found = Vec::new();
        for name in self.sections.keys() {
            if !usual.sections.contains_key(name) && !ORDINARY.contains(&name.as_str()) {
                found.push(format!("a section `{name}`"));
            }
        }
        for name in FIXED {
            let size = |shape: &Self| shape.sections.get(name).copied().unwrap_or(0);
            if size(self) != size(usual) {
                found.push(format!("{} bytes in the section `{name}`, and not {}", size(self), size(usual)));
            }
        }
        let mut more = |what: &str, own: &BTreeSet<String>, usual: &BTreeSet<String>| {
            found.extend(own.difference(usual).map(|name| format!("{what} `{name}`")));
        };
        more("a dynamic entry", &self.dynamic, &usual.dynamic);
        more("a shared library", &self.libraries, &usual.libraries);
        more("an exported symbol", &self.exports, &usual.exports);
        let replaced =
            self.defined.intersection(&usual.imports).filter(|name| !usual.defined.contains(*name));
        found.extend(replaced.map(|name| format!("a function `{name}` of its own in place of a library's")));
        if self.loader != usual.loader {
            found.push("another loader".to_owned());
        }
        if self.resolvers > usual.resolvers {
            found.push("functions that are called while it is loaded".to_owned());
        }
        if !self.starts_as_usual && usual.starts_as_usual {
            found.push("a start of its own".to_owned());
        }
        if self.writes_code && !usual.writes_code {
            found.push("memory that can be written and executed".to_owned());
        }
        found
    }
}

/// True for `R_*_IRELATIVE`, the kind of relocation that calls a function.
fn is_resolver(kind: u32) -> bool {
    let resolver = match std::env::consts::ARCH {
        "x86_64" => elf::R_X86_64_IRELATIVE.0,
        "aarch64" => elf::R_AARCH64_IRELATIVE.0,
        "riscv64" => elf::R_RISCV_IRELATIVE.0,
        _ => return false,
    };
    kind == resolver
}
