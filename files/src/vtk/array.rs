//! Arrays of numbers in VTK's XML, written as base64 of their length and their bytes.

use std::io::{self, Write};

/// Writes an array of floating-point numbers.
pub(super) fn write_numbers(
    out: &mut dyn Write,
    name: &str,
    components: usize,
    numbers: impl Iterator<Item = f64>,
) -> io::Result<()> {
    let attributes = format!("NumberOfComponents=\"{components}\"");
    write_array(out, "Float64", name, &attributes, numbers.map(f64::to_le_bytes))
}

/// Writes an array of whole numbers.
pub(super) fn write_integers(
    out: &mut dyn Write,
    name: &str,
    components: usize,
    numbers: impl Iterator<Item = i64>,
) -> io::Result<()> {
    let attributes = format!("NumberOfComponents=\"{components}\"");
    write_array(out, "Int64", name, &attributes, numbers.map(i64::to_le_bytes))
}

/// Writes a number that applies to the whole file.
pub(super) fn write_field(out: &mut dyn Write, name: &str, number: f64) -> io::Result<()> {
    write_array(out, "Float64", name, "NumberOfTuples=\"1\"", std::iter::once(number.to_le_bytes()))
}

fn write_array(
    out: &mut dyn Write,
    kind: &str,
    name: &str,
    attributes: &str,
    numbers: impl Iterator<Item = [u8; 8]>,
) -> io::Result<()> {
    let mut bytes = vec![0; 8];
    bytes.extend(numbers.flatten());
    let length = (bytes.len() - 8) as u64;
    bytes[..8].copy_from_slice(&length.to_le_bytes());
    write!(out, "<DataArray type=\"{kind}\" Name=\"{name}\" {attributes} format=\"binary\">")?;
    out.write_all(&base64(&bytes))?;
    out.write_all(b"</DataArray>\n")
}

/// Returns the bytes in base64 (RFC 4648).
fn base64(bytes: &[u8]) -> Vec<u8> {
    const LETTERS: &[u8; 64] = b"ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    let mut text = Vec::with_capacity(bytes.len().div_ceil(3) * 4);
    for triple in bytes.chunks(3) {
        let bits =
            triple.iter().fold(0_u32, |bits, &byte| bits << 8 | u32::from(byte)) << (8 * (3 - triple.len()));
        let letters = [18, 12, 6, 0].map(|shift| LETTERS[(bits >> shift & 63) as usize]);
        text.extend(&letters[..=triple.len()]);
        text.extend(&b"=="[..3 - triple.len()]);
    }
    text
}
