//! What a file of machine code is made for, from its first bytes.

use std::env::consts::{ARCH, OS};

/// Bytes that tell (–).
pub(crate) const N_BYTES: usize = 4096;

/// What is wrong with a library that begins with `bytes` on this machine, and what to do; nothing where it is
/// made for it, or where nobody knows.
pub(crate) fn objection(bytes: &[u8]) -> Option<String> {
    let own = match OS {
        "windows" => "Windows",
        "macos" => "macOS",
        _ => "Linux",
    };
    let (system, machine) = match made_for(bytes) {
        Some(found) => found,
        None => {
            return Some(format!(
                "it is no shared library: expected machine code for {own} on {ARCH}; name the compiled library, such as libdiscon.so, not its source or input file"
            ));
        }
    };
    // Other systems than Linux have ELF files too.
    let fits = (system == own || !matches!(OS, "linux" | "windows" | "macos"))
        && machine.is_none_or(|machine| machine == ARCH);
    let machine = machine.unwrap_or("several machines");
    (!fits).then(|| {
        format!("it is made for {system} on {machine}, and this is {own} on {ARCH}: compile or download it for this machine")
    })
}

/// System and architecture, the latter as Rust calls it; no architecture where it is for several or for one
/// that is not known here.
fn made_for(bytes: &[u8]) -> Option<(&'static str, Option<&'static str>)> {
    let half = |at: usize| Some(u16::from_le_bytes(bytes.get(at..at + 2)?.try_into().ok()?));
    let word = |at: usize| Some(u32::from_le_bytes(bytes.get(at..at + 4)?.try_into().ok()?));
    if bytes.starts_with(b"\x7fELF") {
        let machine = match half(18)? {
            3 => Some("x86"),
            40 => Some("arm"),
            62 => Some("x86_64"),
            183 => Some("aarch64"),
            243 => Some("riscv64"),
            _ => None,
        };
        return Some(("Linux", machine));
    }
    if bytes.starts_with(b"MZ") {
        let machine = word(0x3c).and_then(|header| half(header as usize + 4));
        let machine = match machine {
            Some(0x14c) => Some("x86"),
            Some(0x8664) => Some("x86_64"),
            Some(0xaa64) => Some("aarch64"),
            _ => None,
        };
        return Some(("Windows", machine));
    }
    match word(0)? {
        0xfeed_facf => {
            let machine = match word(4)? {
                0x0100_0007 => Some("x86_64"),
                0x0100_000c => Some("aarch64"),
                _ => None,
            };
            Some(("macOS", machine))
        }
        0xbeba_feca => Some(("macOS", None)),
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn formats_and_machines_are_told_apart() {
        let mut elf = b"\x7fELF\x02\x01\x01".to_vec();
        elf.resize(64, 0);
        elf[18] = 183;
        assert_eq!(made_for(&elf), Some(("Linux", Some("aarch64"))));
        let mut windows = b"MZ".to_vec();
        windows.resize(256, 0);
        windows[0x3c] = 0x80;
        windows[0x84..0x86].copy_from_slice(&0x8664_u16.to_le_bytes());
        assert_eq!(made_for(&windows), Some(("Windows", Some("x86_64"))));
        let mac = [0xcf, 0xfa, 0xed, 0xfe, 0x0c, 0, 0, 1];
        assert_eq!(made_for(&mac), Some(("macOS", Some("aarch64"))));
        assert_eq!(made_for(b"! Controller parameter input file"), None);
        assert_eq!(made_for(b""), None);
        // A cut header is no library that anybody knows.
        assert_eq!(made_for(&elf[..10]), None);
    }
}
