//! The viewer's server over raw sockets: what it refuses, what it answers, and what it withstands.

mod answers;
mod endings;
mod load;
mod refusals;
mod surfaces;

use std::fs;
use std::io::{BufRead, BufReader, Read, Write};
use std::net::TcpStream;
use std::path::{Path, PathBuf};
use std::process::{Child, Stdio};
use std::time::Duration;

use serde_json::{Value, json};
use tempfile::TempDir;

use super::{CUBE, command};

/// Waiting longer than this for anything is a failure.
const PATIENCE: Duration = Duration::from_secs(60);

/// A viewer that runs in a folder of its own.
pub(crate) struct Viewer {
    child: Child,
    folder: TempDir,
    port: u16,
    token: String,
}

/// A raw HTTP response.
pub(crate) struct Reply {
    status: u16,
    head: String,
    body: Vec<u8>,
}

impl Viewer {
    /// Starts `hiddenline view` in a folder with `cube.obj`.
    fn start(arguments: &[&str]) -> Self {
        let folder = tempfile::tempdir().unwrap();
        fs::write(folder.path().join("cube.obj"), CUBE).unwrap();
        Self::start_in(folder, arguments)
    }

    fn start_in(folder: TempDir, arguments: &[&str]) -> Self {
        let all = [&["view", "--no-open"], arguments].concat();
        let mut command = command(folder.path(), &all);
        let child = command.stderr(Stdio::piped()).spawn().unwrap();
        Self::listening(child, folder)
    }

    /// Waits until a viewer that was started prints its address.
    fn listening(mut child: Child, folder: TempDir) -> Self {
        let mut lines = BufReader::new(child.stderr.take().unwrap()).lines();
        let address = lines.find_map(|line| {
            let line = line.unwrap();
            line.strip_prefix("http://127.0.0.1:").map(str::to_owned)
        });
        let address = address.expect("the address is printed");
        // Whatever else is said must not fill the pipe.
        std::thread::spawn(move || lines.for_each(drop));
        let (port, token) = address.split_once("/#").unwrap();
        Self { child, folder, port: port.parse().unwrap(), token: token.to_owned() }
    }

    fn path(&self) -> &Path {
        self.folder.path()
    }

    fn host(&self) -> String {
        format!("127.0.0.1:{}", self.port)
    }

    fn connect(&self) -> TcpStream {
        let stream = TcpStream::connect(("127.0.0.1", self.port)).unwrap();
        stream.set_read_timeout(Some(PATIENCE)).unwrap();
        stream
    }

    /// Sends octets as they are and reads the answer.
    fn raw(&self, request: &[u8]) -> Reply {
        let mut stream = self.connect();
        // A server that refuses early may close before all is sent.
        let _ = stream.write_all(request);
        Reply::read(&mut stream)
    }

    /// A request with these header lines besides `Host`.
    fn request(&self, line: &str, headers: &[String], body: &[u8]) -> Reply {
        let host = format!("Host: {}", self.host());
        self.raw(&message(line, &[&[host], headers].concat(), body))
    }

    fn token(&self) -> String {
        format!("X-Hiddenline-Token: {}", self.token)
    }

    fn post(&self, path: &str, body: &[u8]) -> Reply {
        self.request(&format!("POST {path} HTTP/1.1"), &[self.token()], body)
    }

    fn draw(&self, body: &Value) -> Reply {
        self.post("/api/draw", body.to_string().as_bytes())
    }

    /// The first event that a page receives.
    fn about(&self) -> Value {
        let mut events = self.events("test");
        events.next().unwrap()["about"].clone()
    }

    /// The events of a page as they come.
    fn events(&self, page: &str) -> impl Iterator<Item = Value> + use<> {
        let mut stream = self.connect();
        let headers = [format!("Host: {}", self.host()), self.token()];
        let line = format!("GET /api/events?page={page} HTTP/1.1");
        stream.write_all(&message(&line, &headers, b"")).unwrap();
        let lines = BufReader::new(stream).lines();
        // Lines that begin with a brace are events; others are the head and sizes of chunks.
        lines
            .map_while(Result::ok)
            .filter_map(|line| serde_json::from_str(&line).ok())
            .filter(Value::is_object)
    }

    /// Sends a signal by name.
    fn signal(&self, name: &str) {
        let id = self.child.id().to_string();
        let sent = std::process::Command::new("kill").args(["-s", name, &id]).status();
        assert!(sent.unwrap().success());
    }

    /// The exit code, once it has ended.
    fn exit_code(&mut self) -> Option<i32> {
        let start = std::time::Instant::now();
        while start.elapsed() < PATIENCE {
            if let Some(status) = self.child.try_wait().unwrap() {
                return status.code();
            }
            std::thread::sleep(Duration::from_millis(10));
        }
        panic!("the viewer does not end");
    }
}

impl Drop for Viewer {
    fn drop(&mut self) {
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}

/// A request as octets, with the length of its body if it has one.
fn message(line: &str, headers: &[String], body: &[u8]) -> Vec<u8> {
    let mut head = format!("{line}\r\n");
    headers.iter().for_each(|header| head += &format!("{header}\r\n"));
    if !body.is_empty() {
        head += &format!("Content-Length: {}\r\n", body.len());
    }
    [head.as_bytes(), b"\r\n", body].concat()
}

impl Reply {
    /// Reads an answer whose length is given.
    fn read(stream: &mut TcpStream) -> Self {
        let mut head = Vec::new();
        while !head.ends_with(b"\r\n\r\n") {
            let mut byte = [0];
            match stream.read(&mut byte) {
                Ok(1) => head.push(byte[0]),
                _ => break,
            }
        }
        let head = String::from_utf8(head).unwrap();
        let status = head.split(' ').nth(1).and_then(|s| s.parse().ok()).unwrap_or(0);
        let mut reply = Self { status, head, body: Vec::new() };
        let length = reply.header("content-length").and_then(|n| n.parse().ok()).unwrap_or(0);
        reply.body = vec![0; length];
        stream.read_exact(&mut reply.body).unwrap();
        reply
    }

    fn header(&self, name: &str) -> Option<String> {
        let lines = self.head.lines().filter_map(|line| line.split_once(": "));
        let mut values = lines.filter(|(key, _)| key.eq_ignore_ascii_case(name));
        values.next().map(|(_, value)| value.to_owned())
    }

    fn json(&self) -> Value {
        serde_json::from_slice(&self.body)
            .unwrap_or_else(|_| panic!("{}{}", self.head, String::from_utf8_lossy(&self.body)))
    }

    fn facts(&self) -> Value {
        assert_eq!(self.status, 200, "{}", String::from_utf8_lossy(&self.body));
        serde_json::from_str(&self.header("X-Hiddenline-Stats").expect("facts")).unwrap()
    }

    /// The words of a drawing.
    fn words(&self) -> Vec<u32> {
        assert_eq!(self.status, 200, "{}", String::from_utf8_lossy(&self.body));
        assert!(self.body.starts_with(b"HLV1"));
        let words = self.body.chunks_exact(4);
        words.map(|word| u32::from_le_bytes(word.try_into().unwrap())).collect()
    }

    /// The strokes of a drawing with points of `N` numbers.
    fn strokes<const N: usize>(&self) -> Vec<Vec<[f64; N]>> {
        let words = self.words();
        let [groups, strokes, points] = [3, 4, 5].map(|k| words[k] as usize);
        let starts = 6 + 4 * groups;
        let first = starts + strokes + 1;
        assert_eq!(words.len(), first + N * points);
        let numbers: Vec<f64> =
            words[first..].iter().map(|&word| f32::from_bits(word).into()).collect();
        let (all, rest) = numbers.as_chunks::<N>();
        assert!(rest.is_empty());
        words[starts..first]
            .windows(2)
            .map(|ends| all[ends[0] as usize..ends[1] as usize].to_vec())
            .collect()
    }
}

/// What a page asks for with the given options.
fn exact(options: Value) -> Value {
    json!({ "seq": 1, "page": "test", "camera": {}, "options": options, "want": "exact" })
}

/// A command as the page shows it, in words, as a shell takes it.
fn shell_words(command: &str) -> Vec<String> {
    let mut words = vec![String::new()];
    let mut is_quoted = false;
    let mut letters = command.chars().peekable();
    while let Some(c) = letters.next() {
        let last = words.last_mut().unwrap();
        match c {
            '\'' => is_quoted = !is_quoted,
            '\\' if !is_quoted => last.extend(letters.next()),
            ' ' if !is_quoted => words.push(String::new()),
            c => last.push(c),
        }
    }
    words
}

/// Runs a command that the page shows, and reads the file that it writes.
fn written_by(folder: &Path, shown: &str) -> Vec<u8> {
    let words = shell_words(shown);
    assert_eq!(words[0], "hiddenline");
    let words: Vec<&str> = words[1..].iter().map(String::as_str).collect();
    let output = command(folder, &words).output().unwrap();
    assert!(output.status.success(), "{shown}\n{}", String::from_utf8_lossy(&output.stderr));
    let path: PathBuf = folder.join(words.last().unwrap());
    let bytes = fs::read(&path).unwrap();
    fs::remove_file(path).unwrap();
    bytes
}
