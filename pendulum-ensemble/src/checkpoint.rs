//! Checkpoints: files of finished shards, each written atomically.

use super::error::EnsembleError;
use super::gathered::{FailedMember, Tally};
use super::record::{Codec, Record, hash};
use super::shard::Done;
use std::fs::{self, File};
use std::io::{self, Read, Write};
use std::path::{Path, PathBuf};
use std::time::{SystemTime, UNIX_EPOCH};

/// The first bytes of a shard file; the last byte is the version of the format.
const MAGIC: [u8; 8] = *b"pendul\x00\x01";

/// The bytes of a shard file before its payload.
const HEAD: u64 = 32;

/// The greatest size of a settings file, which has some lines.
const MOST_SETTINGS: u64 = 1 << 24;

/// A folder in which finished shards with parts of type `P` are stored.
pub(super) struct Folder<P> {
    pub(super) path: PathBuf,
    pub(super) codec: Codec<P>,
}

/// The folder with the shards of a run, if any, and the hash of the settings of the run.
pub(super) struct Checkpoint<P> {
    folder: Option<Folder<P>>,
    hash: u64,
}

impl<P> Checkpoint<P> {
    /// Opens the folder for a run with these settings, one per line. Returns an error if the folder
    /// belongs to other settings.
    pub(super) fn open(
        folder: Option<Folder<P>>,
        settings: impl FnOnce() -> String,
    ) -> Result<Self, EnsembleError> {
        let Some(Folder { path, .. }) = &folder else { return Ok(Self { folder, hash: 0 }) };
        let settings = settings();
        let hash = hash(settings.as_bytes());
        let failed = |error| failed(path, error);
        fs::create_dir_all(path).map_err(failed)?;
        let file = path.join("settings.txt");
        match read(&file, MOST_SETTINGS).map(|bytes| String::from_utf8(bytes).unwrap_or_default()) {
            Ok(text) => match whole(&text) {
                Some((found, _)) if found == hash => {}
                Some((found, other)) => {
                    let difference = difference(other, &settings);
                    let folder = path.to_owned();
                    return Err(EnsembleError::Refused { folder, found, hash, difference });
                }
                // The file is incomplete. It can be replaced, because each shard file contains the
                // hash as well.
                None => write(&file, titled(hash, &settings).as_bytes()).map_err(failed)?,
            },
            Err(error) if error.kind() == io::ErrorKind::NotFound => {
                write(&file, titled(hash, &settings).as_bytes()).map_err(failed)?;
            }
            Err(error) => return Err(failed(error)),
        }
        Ok(Self { folder, hash })
    }

    /// Reads a shard; returns `None` if its file is missing or damaged.
    pub(super) fn read(&self, shard: usize) -> Result<Option<Done<P>>, EnsembleError> {
        let Some(Folder { path, codec }) = &self.folder else { return Ok(None) };
        let file = file(path, shard);
        // The head tells how long the file is: what follows its end may be endless zeros, as a file
        // system leaves them when it fails, and is not worth any memory.
        let bytes = read(&file, HEAD).map(|head| announced(&head));
        let bytes = match bytes.and_then(|length| length.map(|most| read(&file, most)).transpose())
        {
            Ok(Some(bytes)) => bytes,
            Ok(None) => return Ok(None),
            Err(error) if error.kind() == io::ErrorKind::NotFound => return Ok(None),
            Err(error) => return Err(failed(path, error)),
        };
        let Some((found, index, mut payload)) = opened(&bytes) else { return Ok(None) };
        if found != self.hash {
            let (folder, hash, difference) = (path.clone(), self.hash, String::new());
            return Err(EnsembleError::Refused { folder, found, hash, difference });
        }
        if index != shard {
            return Ok(None);
        }
        let tally = Tally::read(&mut payload);
        let part = (codec.read)(&mut payload);
        Ok(match (tally, part) {
            (Some(tally), Some(part)) if payload.is_empty() => {
                Some(Done { part, tally, resumed: 1 })
            }
            _ => None,
        })
    }

    /// Writes a shard.
    pub(super) fn write(&self, shard: usize, done: &Done<P>) -> Result<(), EnsembleError> {
        let Some(Folder { path, codec }) = &self.folder else { return Ok(()) };
        let mut payload = Vec::new();
        done.tally.write(&mut payload);
        (codec.write)(&done.part, &mut payload);
        let bytes = closed(self.hash, shard, &payload);
        write(&file(path, shard), &bytes).map_err(|error| failed(path, error))
    }

    /// Removes temporary files of interrupted runs; called when all shards are finished.
    pub(super) fn tidy(&self) {
        let Some(Folder { path, .. }) = &self.folder else { return };
        let Ok(entries) = fs::read_dir(path) else { return };
        for entry in entries.flatten() {
            if entry.path().extension().is_some_and(|extension| extension == "tmp") {
                // A failure to remove a temporary file is harmless.
                let _ = fs::remove_file(entry.path());
            }
        }
    }
}

/// Returns the path of the file of a shard.
fn file(folder: &Path, shard: usize) -> PathBuf {
    folder.join(format!("shard-{shard:09}.bin"))
}

/// Returns the content of a shard file: magic, hash of the settings, index, length, payload, and a
/// checksum of all preceding bytes.
fn closed(hash_of_settings: u64, shard: usize, payload: &[u8]) -> Vec<u8> {
    let mut bytes = MAGIC.to_vec();
    (hash_of_settings, shard, payload.len()).write(&mut bytes);
    bytes.extend(payload);
    hash(&bytes).write(&mut bytes);
    bytes
}

/// Returns one byte more than the length of the shard file with this head, so that a longer file is
/// known to be damaged; `None` if this is no head.
fn announced(head: &[u8]) -> Option<u64> {
    let (_, _, length) = <(u64, usize, u64)>::read(&mut head.strip_prefix(&MAGIC)?)?;
    length.checked_add(HEAD + 8 + 1)
}

/// Returns the hash of the settings, the index and the payload of a shard file; `None` if the file
/// is damaged.
fn opened(bytes: &[u8]) -> Option<(u64, usize, &[u8])> {
    let (content, checksum) = bytes.split_last_chunk::<8>()?;
    let mut rest = content.strip_prefix(&MAGIC)?;
    let (settings, shard, length) = <(u64, usize, usize)>::read(&mut rest)?;
    let whole = u64::from_le_bytes(*checksum) == hash(content) && rest.len() == length;
    whole.then_some((settings, shard, rest))
}

/// Reads the first `most` bytes of a file. What can have no content, as a folder, or no end, as a
/// pipe, a device, and a link to one, counts as an empty file.
fn read(file: &Path, most: u64) -> io::Result<Vec<u8>> {
    match fs::metadata(file) {
        Ok(data) if data.is_file() => {
            let mut bytes = Vec::new();
            // A length that no memory holds is an error here, and would end the program below.
            let length = usize::try_from(data.len().min(most)).unwrap_or(usize::MAX);
            bytes.try_reserve_exact(length).map_err(|_| io::ErrorKind::OutOfMemory)?;
            File::open(file)?.take(most).read_to_end(&mut bytes)?;
            Ok(bytes)
        }
        Ok(_) => Ok(Vec::new()),
        // A link that leads nowhere, or in a circle.
        Err(_) if fs::symlink_metadata(file).is_ok_and(|data| data.is_symlink()) => Ok(Vec::new()),
        Err(error) => Err(error),
    }
}

/// Writes a file atomically.
fn write(file: &Path, bytes: &[u8]) -> io::Result<()> {
    // Processes on different machines may have equal process ids.
    let now = SystemTime::now().duration_since(UNIX_EPOCH).map_or(0, |now| now.as_nanos());
    let temporary = file.with_extension(format!("{}-{now}.tmp", std::process::id()));
    let written = File::create(&temporary).and_then(|mut open| {
        open.write_all(bytes)?;
        open.sync_all()
    });
    let renamed = written.and_then(|()| {
        // A file does not replace a folder, whose content may be dear to somebody.
        if fs::symlink_metadata(file).is_ok_and(|data| data.is_dir()) {
            fs::rename(file, temporary.with_extension("folder"))?;
        }
        fs::rename(&temporary, file)
    });
    if let Err(error) = renamed {
        // Frees the space, for example on a full disk.
        let _ = fs::remove_file(&temporary);
        return Err(error);
    }
    // Synchronizes the folder, which contains the name. Some operating systems cannot open folders.
    if let Some(Ok(folder)) = file.parent().map(File::open) {
        let _ = folder.sync_all();
    }
    Ok(())
}

fn failed(folder: &Path, error: io::Error) -> EnsembleError {
    EnsembleError::Io { folder: folder.to_owned(), error }
}

fn titled(hash: u64, settings: &str) -> String {
    format!("hash = {hash:016x}\n{settings}")
}

/// Returns the hash and the settings of a settings file; `None` if the file is incomplete.
fn whole(text: &str) -> Option<(u64, &str)> {
    let (title, settings) = text.split_once('\n')?;
    let found = u64::from_str_radix(title.strip_prefix("hash = ")?, 16).ok()?;
    (found == hash(settings.as_bytes())).then_some((found, settings))
}

/// Returns a description of the first line in which two settings differ.
fn difference(found: &str, own: &str) -> String {
    let pair = found.lines().zip(own.lines()).find(|(found, own)| found != own);
    pair.map_or(String::new(), |(found, own)| format!("there `{found}`, here `{own}`"))
}

impl Record for Tally {
    fn write(&self, bytes: &mut Vec<u8>) {
        let Self { members, failed, failures, evaluations, accepted, rejected } = self;
        (*members, *failed, *evaluations, *accepted, *rejected).write(bytes);
        failures.write(bytes);
    }

    fn read(bytes: &mut &[u8]) -> Option<Self> {
        let (members, failed, evaluations, accepted, rejected) = Record::read(bytes)?;
        let failures = Record::read(bytes)?;
        Some(Self { members, failed, failures, evaluations, accepted, rejected })
    }
}

impl Record for FailedMember {
    fn write(&self, bytes: &mut Vec<u8>) {
        (self.index, self.t).write(bytes);
        self.message.write(bytes);
    }

    fn read(bytes: &mut &[u8]) -> Option<Self> {
        let (index, t, message) = Record::read(bytes)?;
        Some(Self { index, t, error: None, message })
    }
}

#[cfg(test)]
mod tests {
    use super::{closed, hash, opened, titled, whole};

    #[test]
    fn torn_and_damaged_files_are_no_shards() {
        let bytes = closed(7, 3, b"payload");
        assert_eq!(opened(&bytes), Some((7, 3, &b"payload"[..])));
        for length in 0..bytes.len() {
            assert_eq!(opened(&bytes[..length]), None);
        }
        for place in 0..bytes.len() {
            let mut damaged = bytes.clone();
            damaged[place] ^= 0x10;
            assert_eq!(opened(&damaged), None);
        }
    }

    #[test]
    fn settings_know_if_they_are_whole() {
        let text = titled(hash(b"a = 1\n"), "a = 1\n");
        assert_eq!(whole(&text), Some((hash(b"a = 1\n"), "a = 1\n")));
        assert_eq!(whole(&text[..text.len() - 1]), None);
        assert_eq!(whole("hash = 12"), None);
    }
}
