//! What the server withstands: many requests, many connections, readers who leave or do not read.

use std::io::{Read, Write};
use std::net::TcpStream;
use std::thread;
use std::time::Duration;

use serde_json::json;

use super::{Reply, Viewer, exact, message};

#[test]
fn two_pages_are_answered_in_turn() {
    let viewer = Viewer::start(&["cube.obj"]);
    let ask = |page: &str, azimuth: u32| {
        let camera = json!({ "azimuth": azimuth });
        viewer.draw(&json!({ "seq": azimuth, "page": page, "camera": camera, "options": {}, "want": "exact" }))
    };
    thread::scope(|scope| {
        for (page, offset) in [("one", 0), ("two", 100)] {
            scope.spawn(move || {
                for azimuth in offset..offset + 20 {
                    let reply = ask(page, azimuth);
                    // Nothing of another page replaces it.
                    assert_eq!(reply.facts()["seq"], json!(azimuth));
                    assert_eq!(reply.words()[1], azimuth);
                }
            });
        }
    });
}

#[test]
fn of_many_requests_of_a_page_the_last_is_drawn() {
    let viewer = Viewer::start(&["--expr", "sin(r)", "--samples", "151"]);
    let body = |seq: u32| {
        let camera = json!({ "azimuth": f64::from(seq) / 10.0 });
        json!({ "seq": seq, "page": "p", "camera": camera, "options": {}, "want": "drag" })
            .to_string()
    };
    for round in 0..10 {
        // Sent at once, on connections of their own.
        let streams: Vec<TcpStream> = (0..12)
            .map(|k| {
                let mut stream = viewer.connect();
                let headers = [format!("Host: {}", viewer.host()), viewer.token()];
                let body = body(round * 12 + k);
                stream
                    .write_all(&message("POST /api/draw HTTP/1.1", &headers, body.as_bytes()))
                    .unwrap();
                stream
            })
            .collect();
        let replies: Vec<Reply> = streams.into_iter().map(|mut s| Reply::read(&mut s)).collect();
        let drawn: Vec<u32> = replies
            .iter()
            .filter(|reply| reply.status == 200)
            .map(|reply| reply.words()[1])
            .collect();
        // Connections of the round before may not be closed yet, and count.
        assert!(replies.iter().all(|reply| [200, 409, 503].contains(&reply.status)));
        assert!(!drawn.is_empty());
    }
    let last = viewer.draw(&serde_json::from_str(&body(999)).unwrap());
    assert_eq!(last.words()[1], 999);
}

#[test]
fn connections_beyond_the_limit_are_turned_away_and_the_others_go_on() {
    let viewer = Viewer::start(&["cube.obj"]);
    let mut idle: Vec<TcpStream> = (0..16).map(|_| viewer.connect()).collect();
    // One that is served holds its place.
    let headers = [format!("Host: {}", viewer.host())];
    idle[15].write_all(&message("GET / HTTP/1.1", &headers, b"")).unwrap();
    assert_eq!(Reply::read(&mut idle[15]).status, 200);
    assert_eq!(viewer.request("GET / HTTP/1.1", &[], b"").status, 503);
    idle[15].write_all(&message("GET /app.js HTTP/1.1", &headers, b"")).unwrap();
    assert_eq!(Reply::read(&mut idle[15]).status, 200);
    drop(idle);
    let start = std::time::Instant::now();
    while viewer.request("GET / HTTP/1.1", &[], b"").status != 200 {
        assert!(start.elapsed() < Duration::from_secs(10));
        thread::sleep(Duration::from_millis(20));
    }
}

#[test]
fn a_connection_that_says_nothing_is_closed() {
    let viewer = Viewer::start(&["cube.obj"]);
    let mut silent = viewer.connect();
    let mut slow = viewer.connect();
    slow.write_all(b"GET / HTTP/1.1\r\nHost: 127").unwrap();
    let mut body = viewer.connect();
    let headers =
        [format!("Host: {}", viewer.host()), viewer.token(), "Content-Length: 100".into()];
    body.write_all(&message("POST /api/draw HTTP/1.1", &headers, b"")).unwrap();
    for stream in [&mut silent, &mut slow, &mut body] {
        let mut all = Vec::new();
        // Closed within the patience of a test, perhaps after an answer.
        stream.read_to_end(&mut all).unwrap();
        assert!(
            all.is_empty() || all.starts_with(b"HTTP/1.1 408"),
            "{}",
            String::from_utf8_lossy(&all)
        );
    }
}

#[test]
fn readers_who_leave_or_do_not_read_harm_nobody() {
    let viewer = Viewer::start(&["--expr", "sin(r)", "--samples", "41"]);
    let headers = [format!("Host: {}", viewer.host()), viewer.token()];
    let body = exact(json!({ "samples": "41" })).to_string();
    let drawing = message("POST /api/draw HTTP/1.1", &headers, body.as_bytes());
    // So many answers fill every buffer on the way.
    let script = message("GET /app.js HTTP/1.1", &headers, b"");
    let length = Reply::read(&mut {
        let mut stream = viewer.connect();
        stream.write_all(&script).unwrap();
        stream
    });
    let scripts = script.repeat(600);
    let mut unread: Vec<TcpStream> = (0..4).map(|_| viewer.connect()).collect();
    for stream in &mut unread {
        // The server may stop reading before all is sent.
        stream.set_write_timeout(Some(Duration::from_millis(200))).unwrap();
        let _ = stream.write_all(&scripts);
    }
    for k in 0..8 {
        let mut stream = viewer.connect();
        stream.write_all(&drawing).unwrap();
        // Gone before the answer, or in the middle of it.
        if k % 2 == 0 {
            let mut start = [0; 100];
            let _ = stream.read(&mut start);
        }
    }
    assert_eq!(viewer.draw(&exact(json!({ "samples": "21" }))).status, 200);
    thread::sleep(Duration::from_secs(12));
    for mut stream in unread {
        let mut all = Vec::new();
        // Cut off long before the last answer.
        let _ = stream.read_to_end(&mut all);
        assert!(all.len() < 500 * length.body.len(), "{}", all.len());
    }
    assert_eq!(viewer.draw(&exact(json!({ "samples": "21" }))).status, 200);
}

#[test]
fn memory_stays_the_same_over_many_drags() {
    let viewer = Viewer::start(&["cube.obj"]);
    let resident = || -> u64 {
        let status = std::fs::read_to_string(format!("/proc/{}/status", viewer.child.id()))
            .unwrap_or_default();
        let line = status.lines().find_map(|line| line.strip_prefix("VmRSS:")).unwrap_or("0 kB");
        line.trim().trim_end_matches(" kB").parse().unwrap()
    };
    // One connection, as a page has.
    let mut stream = viewer.connect();
    let headers = [format!("Host: {}", viewer.host()), viewer.token()];
    let mut drag = |seq: u32| {
        let camera = json!({ "azimuth": f64::from(seq % 3600) / 10.0 });
        let body =
            json!({ "seq": seq, "page": "p", "camera": camera, "options": {}, "want": "drag" });
        stream
            .write_all(&message("POST /api/draw HTTP/1.1", &headers, body.to_string().as_bytes()))
            .unwrap();
        assert_eq!(Reply::read(&mut stream).words()[1], seq);
    };
    (0..200).for_each(&mut drag);
    let before = resident();
    (200..1200).for_each(&mut drag);
    let after = resident();
    assert!(after < before + 8 * 1024, "{before} kB, then {after} kB");
}
