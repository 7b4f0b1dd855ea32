//! One copy of a library, at work on one turbine.

use crate::registers::Registers;
use crate::{Host, image};
use control::library::{Library, LibraryError, Request};
use libloading::Library as Loaded;
use std::ffi::{CString, c_char, c_int};
use std::fs::{self, File};
use std::io::Read;
use std::path::{Path, PathBuf};
use tempfile::TempDir;

/// Room for a message, its closing zero included (–).
const MESSAGE_ROOM: usize = 1024;
/// Room for what comes back in the name of outputs (–).
const NAME_ROOM: usize = 4096;
/// What the name of outputs ends in, as in OpenFAST: libraries cut the name at its last point.
const NAME_END: &str = ".SrvD";
/// Bytes behind each text that nobody is told of, for libraries that count wrongly (–).
const SPARE: usize = 1024;

/// DISCON(avrSWAP, aviFAIL, accINFILE, avcOUTNAME, avcMSG).
type Procedure = unsafe extern "C" fn(*mut f32, *mut c_int, *mut c_char, *mut c_char, *mut c_char);

/// A library with its buffers.
pub(crate) struct Instance {
    procedure: Procedure,
    input: Vec<u8>,
    /// Name of outputs, as it is sent.
    name: Vec<u8>,
    /// The same as the library gets and may change it.
    name_sent: Vec<u8>,
    message: Vec<u8>,
    #[cfg(unix)]
    last_words: &'static [u8],
    // In the order in which they go.
    _copy: Loaded,
    /// The file itself, never called: libraries that it needs and finds beside itself are loaded with it, and
    /// the copy finds them there.
    _original: Loaded,
    _scratch: TempDir,
}

impl Instance {
    /// A copy of the library that is `asked` for, at work for `host`.
    ///
    /// # Errors
    /// [`LibraryError`].
    pub(crate) fn open(host: &Host, asked: &Request) -> Result<Self, LibraryError> {
        let path = existing(host, &asked.library, "library")?;
        let refuse = |what: String| LibraryError(format!("{}: {what}", path.display()));
        let input = match &asked.input {
            Some(input) => existing(host, input, "input file of the controller library")?,
            None => PathBuf::new(),
        };
        let mut head = Vec::new();
        File::open(&path)
            .and_then(|file| file.take(image::N_BYTES as u64).read_to_end(&mut head))
            .map_err(|error| refuse(format!("it cannot be read ({error})")))?;
        if let Some(objection) = image::objection(&head) {
            return Err(refuse(objection));
        }
        let copied = |error: std::io::Error| {
            refuse(format!(
                "it cannot be copied into the folder of temporary files ({error}); free space there, or set TMPDIR to another folder"
            ))
        };
        let scratch = tempfile::Builder::new().prefix("wakemix-").tempdir().map_err(copied)?;
        let copy = scratch.path().join(path.file_name().unwrap_or_default());
        fs::copy(&path, &copy).map_err(copied)?;
        #[cfg(unix)]
        crate::last_words::install();
        let [original, loaded] = loaded(&[&path, &copy]).map_err(refuse)?;
        // What is loaded needs no name on Unix, and a killed process leaves nothing of it.
        #[cfg(unix)]
        let _ = fs::remove_file(&copy);
        let procedure = procedure(&loaded, &asked.procedure).map_err(refuse)?;
        let folder = host.outputs.as_deref().unwrap_or(scratch.path());
        let name = folder.join(format!("{}{NAME_END}", host.turbine));
        let name = zero_ended(&std::path::absolute(&name).unwrap_or(name)).map_err(refuse)?;
        if name.len() > NAME_ROOM {
            return Err(refuse(format!(
                "the path of its outputs has {} characters, {NAME_ROOM} are the most; take a shorter folder with -o",
                name.len()
            )));
        }
        Ok(Self {
            procedure,
            input: zero_ended(&input).map_err(refuse)?,
            name_sent: vec![0; NAME_ROOM + SPARE],
            name,
            message: vec![0; MESSAGE_ROOM + SPARE],
            #[cfg(unix)]
            last_words: last_words(&path, &host.turbine, &asked.procedure),
            _copy: loaded,
            _original: original,
            _scratch: scratch,
        })
    }
}

impl Library for Instance {
    fn call(&mut self, swap: &mut [f32]) -> i32 {
        let lengths = [MESSAGE_ROOM, self.input.len(), self.name.len(), NAME_ROOM];
        for (record, length) in control::discon::TEXTS.into_iter().zip(lengths) {
            swap[record - 1] = length as f32;
        }
        self.message.fill(0);
        self.name_sent.fill(0);
        self.name_sent[..self.name.len()].copy_from_slice(&self.name);
        let mut flag: c_int = 0;
        #[cfg(unix)]
        let _within = crate::last_words::Within::library(self.last_words);
        let _registers = Registers::kept();
        // SAFETY: the arrays are as long as records 49, 50, 51 and 64 say and the swap array as the interface
        // has it, all live through the call, and the library stays loaded as long as `self`. That the
        // procedure is the one of the interface, its author vouches for.
        unsafe {
            (self.procedure)(
                swap.as_mut_ptr(),
                &raw mut flag,
                self.input.as_mut_ptr().cast(),
                self.name_sent.as_mut_ptr().cast(),
                self.message.as_mut_ptr().cast(),
            );
        }
        flag
    }

    fn message(&self) -> String {
        let text = &self.message[..MESSAGE_ROOM];
        let end = text.iter().position(|byte| *byte == 0).unwrap_or(text.len());
        let text = String::from_utf8_lossy(&text[..end]);
        let line = text.split_whitespace().collect::<Vec<_>>().join(" ");
        line.chars().filter(|c| !c.is_control()).collect()
    }
}

/// The file `name` of the case of `host`, by its whole path; `what` says what it is.
///
/// # Errors
/// [`LibraryError`] where there is none.
fn existing(host: &Host, name: &str, what: &str) -> Result<PathBuf, LibraryError> {
    let path = host.folder.join(name);
    let found = path.is_file().then(|| std::path::absolute(&path).ok()).flatten();
    found.ok_or_else(|| {
        LibraryError(format!(
            "there is no {what} {}: put it there, or correct the path, which is relative to the case file",
            path.display()
        ))
    })
}

/// The libraries at `paths`, all that they need resolved.
///
/// # Errors
/// What the system says, and what may be done.
fn loaded(paths: &[&Path; 2]) -> Result<[Loaded; 2], String> {
    let _registers = Registers::kept();
    let load = |path: &Path| {
        // SAFETY: what a library does as it is loaded, its author vouches for.
        #[cfg(unix)]
        let loaded = unsafe {
            use libloading::os::unix;
            unix::Library::open(Some(path), unix::RTLD_NOW | unix::RTLD_LOCAL).map(Loaded::from)
        };
        // SAFETY: as above.
        #[cfg(not(unix))]
        let loaded = unsafe { Loaded::new(path) };
        loaded.map_err(|error| {
            let mut message = error.to_string();
            if let Some(cause) = std::error::Error::source(&error) {
                message += &format!(": {cause}");
            }
            format!("the system cannot load it ({message}); a library that it needs must be where the system looks, beside it or in a folder of LD_LIBRARY_PATH (PATH on Windows), and TMPDIR must allow programs to run from it")
        })
    };
    Ok([load(paths[0])?, load(paths[1])?])
}

/// The procedure called `name` in `library`.
///
/// # Errors
/// That there is none, and what to do.
fn procedure(library: &Loaded, name: &str) -> Result<Procedure, String> {
    // SAFETY: that a procedure of this name has the interface's arguments, its author vouches for; the
    // library outlives the pointer in `Instance`.
    unsafe { library.get::<Procedure>(name.as_bytes()) }.map(|found| *found).map_err(|_| {
        format!("it has no procedure `{name}`: export it under this name (Fortran: BIND(C, NAME='{name}'), C++: extern \"C\"), or name the one that it has with `procedure`; libraries of Bladed's newer interface (CONTROLLER) are not supported")
    })
}

/// `path` as a text that ends with a zero.
fn zero_ended(path: &Path) -> Result<Vec<u8>, String> {
    let text = path.to_str().ok_or("its path, or that of its input, is not UTF-8: rename it")?;
    let text = CString::new(text).map_err(|_| "a path holds a zero: rename it")?;
    Ok(text.into_bytes_with_nul())
}

/// What is written when the library at `path` takes the program along while it works on `turbine`. It is kept
/// for good, since a handler may need it at any time: a line for each library and turbine.
#[cfg(unix)]
fn last_words(path: &Path, turbine: &str, procedure: &str) -> &'static [u8] {
    let text = format!(
        "\nerror: the controller library {} of {turbine} ended the program within its procedure {procedure}: the run cannot go on. Its author can tell why; a library that reads records beyond those of docs/how-to/own-controller.md, or another version of its input file, is the usual cause. What was recorded before stays; --resume takes the run up at its last checkpoint.\n",
        path.display()
    );
    Box::leak(text.into_boxed_str()).as_bytes()
}
