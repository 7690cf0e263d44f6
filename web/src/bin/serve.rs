//! Builds the page and serves it to this machine's browsers.
//!
//! ```text
//! cargo run --release --manifest-path web/Cargo.toml
//! cargo run --release --manifest-path web/Cargo.toml -- 8080
//! ```
//!
//! The argument is the port, 8000 by default. The folder `web/dist` then holds the whole page, for any
//! static server; `build` in place of a port makes it and ends.

use std::error::Error;
use std::fs;
use std::io::{BufRead, BufReader, Write};
use std::net::{Ipv4Addr, TcpListener, TcpStream};
use std::path::{Path, PathBuf};
use std::process::Command;

const TARGET: &str = "wasm32-unknown-unknown";

/// The files of the page, and what they are.
const FILES: [(&str, &str); 5] = [
    ("index.html", "text/html; charset=utf-8"),
    ("style.css", "text/css; charset=utf-8"),
    ("page.js", "text/javascript; charset=utf-8"),
    ("worker.js", "text/javascript; charset=utf-8"),
    ("rolls.wasm", "application/wasm"),
];

fn main() -> Result<(), Box<dyn Error>> {
    let argument = std::env::args().nth(1);
    let dist = build()?;
    println!("the page is in {}", dist.display());
    if argument.as_deref() == Some("build") {
        return Ok(());
    }
    let port: u16 = argument.map_or(Ok(8000), |text| text.parse())?;
    let listener = TcpListener::bind((Ipv4Addr::LOCALHOST, port))?;
    println!("open http://{} in a browser; Ctrl-C ends", listener.local_addr()?);
    for stream in listener.incoming().flatten() {
        let dist = dist.clone();
        // A browser that goes away in the middle is no error.
        std::thread::spawn(move || answer(stream, &dist).ok());
    }
    Ok(())
}

/// Compiles the library to WebAssembly, and puts it beside the page.
fn build() -> Result<PathBuf, Box<dyn Error>> {
    let web = Path::new(env!("CARGO_MANIFEST_DIR"));
    let target = web.join("target");
    let status = Command::new(env!("CARGO"))
        .args(["build", "--release", "--lib", "--target", TARGET, "--manifest-path"])
        .arg(web.join("Cargo.toml"))
        .arg("--target-dir")
        .arg(&target)
        .status()?;
    if !status.success() {
        return Err(format!("the build failed; is the target there? rustup target add {TARGET}").into());
    }
    let dist = web.join("dist");
    fs::create_dir_all(&dist)?;
    for (name, _) in FILES.iter().filter(|(name, _)| *name != "rolls.wasm") {
        fs::copy(web.join("page").join(name), dist.join(name))?;
    }
    fs::copy(target.join(TARGET).join("release").join("rolls.wasm"), dist.join("rolls.wasm"))?;
    Ok(dist)
}

/// Answers one request: a file of the page, or none.
fn answer(mut stream: TcpStream, dist: &Path) -> std::io::Result<()> {
    let mut reader = BufReader::new(stream.try_clone()?);
    let mut request = String::new();
    reader.read_line(&mut request)?;
    let mut header = String::new();
    while reader.read_line(&mut header)? > 2 {
        header.clear();
    }
    let path = request.split_whitespace().nth(1).unwrap_or("/");
    let name = path.split(['?', '#']).next().unwrap_or("/").trim_start_matches('/');
    let name = if name.is_empty() { "index.html" } else { name };
    // Only names of this list are opened, so no path leads out of the folder.
    let Some((name, kind)) = FILES.iter().find(|(known, _)| *known == name) else {
        return stream.write_all(b"HTTP/1.1 404 Not Found\r\nContent-Length: 0\r\nConnection: close\r\n\r\n");
    };
    let body = fs::read(dist.join(name))?;
    let length = body.len();
    write!(
        stream,
        "HTTP/1.1 200 OK\r\nContent-Type: {kind}\r\nContent-Length: {length}\r\nConnection: close\r\n\r\n"
    )?;
    stream.write_all(&body)
}
