//! The server: connections on 127.0.0.1, limited in number and in waiting time.

use std::convert::Infallible;
use std::io;
use std::net::{Ipv4Addr, SocketAddr};
use std::sync::Arc;
use std::sync::atomic::Ordering;
use std::time::Duration;

use hyper::server::conn::http1;
use hyper::service::service_fn;
use hyper_util::rt::{TokioIo, TokioTimer};
use tokio::io::AsyncWriteExt;
use tokio::net::{TcpListener, TcpStream};
use tokio::sync::Semaphore;
use tokio::time::{sleep, timeout};

use super::patient::Patient;
use super::routes::{Shared, answer};

/// Most connections at once.
const MOST_CONNECTIONS: usize = 16;
/// How long a connection may take to say what it wants.
const HEADER_PATIENCE: Duration = Duration::from_secs(10);
/// How long a page may be away, as when it is loaded again, before it counts as closed.
const ABSENCE: Duration = Duration::from_secs(2);
const MOST_HEADERS: usize = 64;
const LARGEST_HEAD: usize = 1 << 15;

/// Binds a port of this machine; 0 is a free one.
pub(super) async fn bind(port: u16) -> io::Result<TcpListener> {
    TcpListener::bind(SocketAddr::from((Ipv4Addr::LOCALHOST, port))).await
}

/// Serves until a signal requests the end or, with `once`, the last page was closed.
pub(super) async fn serve(
    listener: TcpListener,
    shared: Arc<Shared>,
    once: bool,
) -> io::Result<()> {
    let free = Arc::new(Semaphore::new(MOST_CONNECTIONS));
    let accept = async {
        loop {
            match listener.accept().await {
                Ok((stream, _)) => match free.clone().try_acquire_owned() {
                    Ok(permit) => {
                        let shared = shared.clone();
                        tokio::spawn(async move {
                            connection(stream, shared).await;
                            drop(permit);
                        });
                    }
                    Err(_) => {
                        tokio::spawn(turn_away(stream));
                    }
                },
                // Such as too many open files: others may be closed soon.
                Err(_) => sleep(Duration::from_millis(50)).await,
            }
        }
    };
    tokio::select! {
        () = accept => Ok(()),
        asked = asked_to_end() => asked,
        () = all_closed(&shared), if once => Ok(()),
    }
}

async fn connection(stream: TcpStream, shared: Arc<Shared>) {
    // Small answers should not wait for more.
    let _ = stream.set_nodelay(true);
    let service = service_fn(move |request| {
        let shared = shared.clone();
        async move { answer(request, shared).await as Result<_, Infallible> }
    });
    let mut http = http1::Builder::new();
    http.timer(TokioTimer::new())
        .header_read_timeout(HEADER_PATIENCE)
        .max_headers(MOST_HEADERS)
        .max_buf_size(LARGEST_HEAD);
    // Whatever goes wrong is the other side's matter.
    let _ = http.serve_connection(TokioIo::new(Patient::new(stream)), service).await;
}

/// Tells that there are too many connections.
async fn turn_away(mut stream: TcpStream) {
    const BUSY: &[u8] = b"HTTP/1.1 503 Service Unavailable\r\nConnection: close\r\n\
                          Content-Length: 0\r\nRetry-After: 1\r\n\r\n";
    let _ = timeout(Duration::from_secs(1), stream.write_all(BUSY)).await;
}

/// Waits until pages were open and all of them are closed.
async fn all_closed(shared: &Shared) {
    loop {
        shared.left.notified().await;
        sleep(ABSENCE).await;
        if shared.pages.load(Ordering::Acquire) == 0 {
            return;
        }
    }
}

/// Waits for Ctrl-C or for the signal to terminate.
async fn asked_to_end() -> io::Result<()> {
    #[cfg(unix)]
    {
        use tokio::signal::unix::{SignalKind, signal};
        let mut terminate = signal(SignalKind::terminate())?;
        let mut interrupt = signal(SignalKind::interrupt())?;
        tokio::select! {
            _ = terminate.recv() => {}
            _ = interrupt.recv() => {}
        }
        Ok(())
    }
    #[cfg(not(unix))]
    tokio::signal::ctrl_c().await
}
