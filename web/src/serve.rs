//! A server of one folder for this machine: files of plain names by GET, no more.

use std::fs;
use std::io::{BufRead, BufReader, Read, Write};
use std::net::{Ipv4Addr, TcpListener, TcpStream};
use std::path::{Path, PathBuf};
use std::time::Duration;

use rolls::Failure;

/// Longest first line of a request.
const LONGEST: u64 = 4096;

/// Serves until the program is ended. Port 0 is any free one.
pub(crate) fn serve(folder: &Path, port: u16) -> Result<(), Failure> {
    let listener =
        TcpListener::bind((Ipv4Addr::LOCALHOST, port)).map_err(|error| format!("port {port}: {error}"))?;
    println!("serving {}\nat http://{}/ until Ctrl-C", folder.display(), listener.local_addr()?);
    for stream in listener.incoming().flatten() {
        let folder = folder.to_owned();
        // A browser that goes away in mid-answer is no fault of the server.
        std::thread::spawn(move || answer(&stream, &folder).ok());
    }
    Ok(())
}

fn answer(mut stream: &TcpStream, folder: &Path) -> std::io::Result<()> {
    stream.set_read_timeout(Some(Duration::from_secs(10)))?;
    let mut reader = BufReader::new(stream.take(16 * LONGEST));
    let mut line = String::new();
    reader.by_ref().take(LONGEST).read_line(&mut line)?;
    // The headers are read to their end: a socket closed before that would be reset.
    for header in reader.lines() {
        if header?.is_empty() {
            break;
        }
    }
    let file = requested(&line).map(|name| folder.join(name));
    let (status, kind, body) = match file.and_then(|file| Some((kind(&file), fs::read(&file).ok()?))) {
        Some((kind, body)) => ("200 OK", kind, body),
        None => ("404 Not Found", "text/plain", b"there is no such file".to_vec()),
    };
    write!(
        stream,
        "HTTP/1.1 {status}\r\nContent-Type: {kind}\r\nContent-Length: {}\r\nCache-Control: no-cache\r\n\
         Connection: close\r\n\r\n",
        body.len()
    )?;
    stream.write_all(&body)
}

/// Returns the name of the file that a request line asks for. Names have no slash, so that nothing outside
/// of the folder is reached.
fn requested(line: &str) -> Option<PathBuf> {
    let path = line.strip_prefix("GET /")?.split([' ', '?']).next()?;
    let plain = path.chars().all(|letter| letter.is_ascii_alphanumeric() || "-_.".contains(letter));
    let name = if path.is_empty() { "index.html" } else { path };
    (plain && !name.starts_with('.')).then(|| name.into())
}

fn kind(file: &Path) -> &'static str {
    match file.extension().and_then(|extension| extension.to_str()) {
        Some("html") => "text/html; charset=utf-8",
        Some("css") => "text/css; charset=utf-8",
        Some("js") => "text/javascript; charset=utf-8",
        Some("wasm") => "application/wasm",
        _ => "text/plain; charset=utf-8",
    }
}

#[cfg(test)]
mod tests {
    use std::path::PathBuf;

    use super::requested;

    #[test]
    fn only_files_of_the_folder_are_served() {
        assert_eq!(requested("GET / HTTP/1.1\r\n"), Some(PathBuf::from("index.html")));
        assert_eq!(requested("GET /page.js?x=1 HTTP/1.1\r\n"), Some(PathBuf::from("page.js")));
        for line in [
            "GET /../Cargo.toml HTTP/1.1",
            "GET /.. HTTP/1.1",
            "GET //etc/passwd HTTP/1.1",
            "GET /%2e%2e/x H",
            "POST / HTTP/1.1",
            "",
        ] {
            assert_eq!(requested(line), None, "{line}");
        }
    }
}
