//! `view --gif` and `--frames`: what the viewer shows of a recording as a moving picture, or as PNGs.

use super::error::CliError;
use super::output::{print, say};
use super::steered::Steered;
use super::viewer::Viewer;
use crate::files::{FileError, make_folder, write_whole};
use clap::Args;
use gif::{Encoder, Frame, Repeat};
use std::fs::File;
use std::io::BufReader;
use std::path::{Path, PathBuf};

/// Quantisation of colours: 1 is best, 30 fastest.
const SPEED: i32 = 10;
/// Hundredths of a second that the last picture stands.
const LAST: u16 = 100;

#[derive(Args)]
pub(super) struct FilmArgs {
    /// Simulated time of the first picture, s [default: the decisive stretch]
    #[arg(long, value_name = "S")]
    from: Option<f64>,
    /// Simulated time of the last picture, s [default: the decisive stretch]
    #[arg(long, value_name = "S")]
    to: Option<f64>,
    /// Number of pictures
    #[arg(long, value_name = "N", default_value_t = 60)]
    pictures: u32,
    /// Pictures in a second
    #[arg(long, value_name = "N", default_value_t = 12)]
    fps: u16,
    /// Width and height in pixels
    #[arg(long, value_name = "WxH", default_value = "1280x800", value_parser = size)]
    size: [u32; 2],
}

fn size(text: &str) -> Result<[u32; 2], String> {
    let parsed = text.split_once('x').and_then(|(w, h)| Some([w.parse().ok()?, h.parse().ok()?]));
    let is_size = |size: &[u32; 2]| size.iter().all(|length| (64..=4096).contains(length));
    parsed.filter(is_size).ok_or_else(|| "expected e.g. 1280x800, from 64 to 4096".to_string())
}

impl FilmArgs {
    /// Makes the pictures of a recording (.rrd).
    ///
    /// # Errors
    /// The times are no stretch, the viewer cannot show it, or the machine failed.
    pub(super) fn make(
        &self,
        viewer: &Viewer,
        file: &Path,
        gif: Option<&Path>,
        frames: Option<&Path>,
        quiet: bool,
    ) -> Result<(), CliError> {
        let (known, has_end) = stretch_of(file)?;
        let [from_s, to_s] = self.stretch_s(known)?;
        if self.pictures == 0 || self.fps == 0 || self.fps > 50 {
            return Err(CliError::Input("--pictures, --fps: expected at least 1, and at most 50 in a second".into()));
        }
        let folder = match frames {
            Some(folder) => folder.to_path_buf(),
            None => beside(gif.unwrap_or(file)),
        };
        make_folder(&folder)?;
        let made = self.pictures(Steered::open(viewer, file, self.size, has_end)?, [from_s, to_s], &folder, quiet);
        let written = made.and_then(|files| {
            gif.map_or(Ok(()), |gif| {
                write_whole(gif, &self.film(&files)?)?;
                print(gif.display());
                Ok(())
            })
        });
        match frames {
            Some(folder) => {
                written?;
                print(folder.display());
                if !quiet {
                    say(format!(
                        "film: ffmpeg -framerate {} -i {}/%04d.png -pix_fmt yuv420p film.mp4",
                        self.fps,
                        folder.display()
                    ));
                }
                Ok(())
            }
            None => {
                let removed = std::fs::remove_dir_all(&folder);
                written?;
                Ok(removed.map_err(|error| FileError::new(&folder, error))?)
            }
        }
    }

    fn stretch_s(&self, known: [f64; 2]) -> Result<[f64; 2], CliError> {
        let [from_s, to_s] = [self.from.unwrap_or(known[0]), self.to.unwrap_or(known[1])];
        if from_s.is_finite() && to_s.is_finite() && 0.0 <= from_s && from_s <= to_s {
            return Ok([from_s, to_s]);
        }
        Err(CliError::Input(format!("--from {from_s} --to {to_s}: expected 0 ≤ from ≤ to")))
    }

    fn pictures(
        &self,
        mut steered: Steered,
        [from_s, to_s]: [f64; 2],
        folder: &Path,
        quiet: bool,
    ) -> Result<Vec<PathBuf>, CliError> {
        let mut files = Vec::new();
        for i in 0..self.pictures {
            let part = if self.pictures > 1 { f64::from(i) / f64::from(self.pictures - 1) } else { 1.0 };
            let path = folder.join(format!("{i:04}.png"));
            steered.picture(from_s + part * (to_s - from_s), &path)?;
            files.push(path);
            if !quiet && (i + 1) % 10 == 0 {
                say(format!("{} of {} pictures", i + 1, self.pictures));
            }
        }
        Ok(files)
    }

    /// The pictures as a GIF that begins anew.
    fn film(&self, files: &[PathBuf]) -> Result<Vec<u8>, CliError> {
        let failed =
            |error: &dyn std::fmt::Display| CliError::Machine(format!("cannot make the moving picture: {error}"));
        let mut bytes = Vec::new();
        let [width, height] = self.size.map(|length| length as u16);
        let mut encoder = Encoder::new(&mut bytes, width, height, &[]).map_err(|error| failed(&error))?;
        encoder.set_repeat(Repeat::Infinite).map_err(|error| failed(&error))?;
        for (i, file) in files.iter().enumerate() {
            let (size, mut pixels) = rgb(file)?;
            if size != self.size {
                return Err(failed(&format!("a picture of {} × {} pixels", size[0], size[1])));
            }
            let mut frame = Frame::from_rgb_speed(width, height, &pixels, SPEED);
            pixels.clear();
            frame.delay = if i + 1 == files.len() { LAST } else { 100 / self.fps };
            encoder.write_frame(&frame).map_err(|error| failed(&error))?;
        }
        drop(encoder);
        Ok(bytes)
    }
}

/// Folder for pictures that are only needed for a while.
fn beside(file: &Path) -> PathBuf {
    let mut name = file.as_os_str().to_owned();
    name.push(".frames");
    name.into()
}

/// Size and pixels of a PNG of eight bits.
fn rgb(file: &Path) -> Result<([u32; 2], Vec<u8>), CliError> {
    let failed = |error: &dyn std::fmt::Display| CliError::Machine(format!("{}: {error}", file.display()));
    let open = File::open(file).map_err(|error| FileError::new(file, error))?;
    let mut reader = png::Decoder::new(BufReader::new(open)).read_info().map_err(|error| failed(&error))?;
    let mut bytes = vec![0; reader.output_buffer_size().unwrap_or(0)];
    let info = reader.next_frame(&mut bytes).map_err(|error| failed(&error))?;
    let channels = info.color_type.samples();
    if channels < 3 {
        return Err(failed(&"expected a picture in colour"));
    }
    let pixels = bytes[..info.buffer_size()].chunks(channels).flat_map(|p| [p[0], p[1], p[2]]).collect();
    Ok(([info.width, info.height], pixels))
}

/// The stretch that a recording plays, or all of it, and whether the end of its run is in it.
#[cfg(feature = "rerun")]
fn stretch_of(file: &Path) -> Result<([f64; 2], bool), CliError> {
    use crate::record::rerun::mend::{stretch_of, whole_of};
    if let Some(stretch_s) = stretch_of(file)? {
        return Ok((stretch_s, true));
    }
    let whole = whole_of(file)?.ok_or_else(|| {
        CliError::Input(format!("{}: expected a recording with samples, found none that is whole", file.display()))
    })?;
    Ok(([0.0, whole.until_s.unwrap_or(0.0)], false))
}

#[cfg(not(feature = "rerun"))]
fn stretch_of(_: &Path) -> Result<([f64; 2], bool), CliError> {
    Ok(([0.0, 0.0], false))
}
