//! A web server for one page on this machine: on loopback, and only for clients that know its address, which has a random
//! secret. Other pages, which know neither, get nothing: a request that is not allowed gets the answer for a missing page.
//!
//! Passes messages on and knows nothing of what they mean.

use std::convert::Infallible;
use std::fmt;
use std::fmt::Write;
use std::io;
use std::net::{Ipv4Addr, TcpListener};
use std::sync::Arc;
use std::thread;
use std::time::Duration;

use futures::future::BoxFuture;
use futures::{StreamExt, stream};
use http_body_util::combinators::UnsyncBoxBody;
use http_body_util::{BodyExt, Full, Limited, StreamBody};
use hyper::body::{Bytes, Frame, Incoming};
use hyper::header::{self, HeaderMap, HeaderName, HeaderValue};
use hyper::server::conn::http1;
use hyper::service::service_fn;
use hyper::{Method, Request, Response, StatusCode};
use hyper_util::rt::{TokioIo, TokioTimer};
use tokio::io::AsyncWriteExt;
use tokio::net::TcpStream;
use tokio::runtime;
use tokio::sync::{Semaphore, broadcast, oneshot};
use tokio::time::{sleep, timeout};

use crate::log::log;

/// The bytes of the secret in an address, which is to fit into a line of a terminal.
const SECRET_BYTES: usize = 16;

/// The longest message of a page.
const MAX_BYTES: usize = 64 << 10;

/// The time in which the head of a request has to arrive, and its body again.
const REQUEST_TIMEOUT: Duration = Duration::from_secs(3);

/// The maximum number of open connections; a browser opens six for one page. Others wait until the slow ones are dropped, and
/// are refused if none is.
const MOST_CONNECTIONS: usize = 128;

/// The maximum number of connections that wait for that. Still others are closed.
const MAX_WAITING: usize = 128;

/// The answer to a connection that has waited in vain.
const FULL: &str = "HTTP/1.1 503 Service Unavailable\r\nContent-Type: text/plain\r\nContent-Length: 62\r\n\
    Connection: close\r\n\r\nToo many pages are connected to the preview: close some first\n";

/// The maximum number of events that wait for a page that is slow to read.
const MAX_EVENTS: usize = 256;

/// The headers of every answer: nothing is loaded from elsewhere, nothing shows the page in a frame, and no copy is
/// kept.
const HEADERS: [(HeaderName, &str); 6] = [
    (
        header::CONTENT_SECURITY_POLICY,
        "default-src 'none'; script-src 'self'; style-src 'self'; connect-src 'self'; img-src data:; base-uri 'none'; \
         form-action 'none'; frame-ancestors 'none'",
    ),
    (header::X_CONTENT_TYPE_OPTIONS, "nosniff"),
    (header::REFERRER_POLICY, "no-referrer"),
    (header::CACHE_CONTROL, "no-store"),
    (HeaderName::from_static("cross-origin-resource-policy"), "same-origin"),
    (HeaderName::from_static("cross-origin-opener-policy"), "same-origin"),
];

/// A file that pages may load; the page itself has an empty name.
#[derive(Debug, Clone, Copy)]
pub(crate) struct File {
    pub(crate) name: &'static str,
    pub(crate) media_type: &'static str,
    pub(crate) content: &'static [u8],
}

/// Answers a message of a page.
type Answer = Box<dyn Fn(Bytes) -> BoxFuture<'static, Vec<u8>> + Send + Sync>;

/// The files, events and answers that pages get.
pub(crate) struct Site {
    pub(crate) files: &'static [File],
    /// The first event of a page; later ones come from [`Sender::send`].
    pub(crate) greet: Box<dyn Fn() -> Vec<u8> + Send + Sync>,
    /// Runs within a Tokio runtime.
    pub(crate) answer: Answer,
}

/// A server that runs until it is dropped.
pub(crate) struct WebServer {
    /// The page's address, with its secret.
    pub(crate) address: String,
    /// Sends events to all pages.
    pub(crate) events: Sender,
    _stop: oneshot::Sender<()>,
}

impl fmt::Debug for WebServer {
    // Without the address, which is a secret.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("WebServer").finish_non_exhaustive()
    }
}

/// Sends events to all pages.
#[derive(Debug, Clone)]
pub(crate) struct Sender(broadcast::Sender<Bytes>);

impl Sender {
    /// Sends an event, one line of text.
    pub(crate) fn send(&self, event: &[u8]) {
        // Without pages nobody receives it.
        let _ = self.0.send(frame(event));
    }
}

impl WebServer {
    /// Serves a site on a port of this machine; 0 is any free one.
    ///
    /// # Errors
    ///
    /// If the port is not free, or the system has no random numbers or no thread.
    pub(crate) fn start(port: u16, site: Site) -> io::Result<Self> {
        let secret = secret()?;
        let listener = TcpListener::bind((Ipv4Addr::LOCALHOST, port))?;
        listener.set_nonblocking(true)?;
        let host = listener.local_addr()?.to_string();
        let address = format!("http://{host}/{secret}/");
        let (events, _) = broadcast::channel(MAX_EVENTS);
        let (stop, stopped) = oneshot::channel();
        let origin = format!("http://{host}");
        let door = Arc::new(Door { host, origin, secret, site, events: events.clone() });
        let runtime = runtime::Builder::new_current_thread().enable_all().build()?;
        thread::Builder::new().name("preview".to_owned()).spawn(move || {
            runtime.block_on(async {
                tokio::select! {
                    _ = stopped => {}
                    end = accept(listener, door) => {
                        if let Err(error) = end {
                            log(format_args!("the preview's page is gone: {error}"));
                        }
                    }
                }
            });
            // Whatever is still open ends here.
            runtime.shutdown_background();
        })?;
        Ok(Self { address, events: Sender(events), _stop: stop })
    }
}

/// A secret for an address: as hexadecimal digits.
fn secret() -> io::Result<String> {
    let mut random = [0; SECRET_BYTES];
    getrandom::fill(&mut random).map_err(io::Error::other)?;
    Ok(random.iter().fold(String::new(), |mut text, byte| {
        let _ = write!(text, "{byte:02x}");
        text
    }))
}

type Body = UnsyncBoxBody<Bytes, Infallible>;

/// Decides who may enter.
struct Door {
    /// The `Host` of the address; a name that resolves to this machine has another one.
    host: String,
    origin: String,
    secret: String,
    site: Site,
    events: broadcast::Sender<Bytes>,
}

/// Accepts connections until it fails.
async fn accept(listener: TcpListener, door: Arc<Door>) -> io::Result<()> {
    let listener = tokio::net::TcpListener::from_std(listener)?;
    let (room, queue) = (Arc::new(Semaphore::new(MOST_CONNECTIONS)), Arc::new(Semaphore::new(MAX_WAITING)));
    loop {
        match listener.accept().await {
            Ok((stream, _)) => {
                let Ok(place) = Arc::clone(&queue).try_acquire_owned() else { continue };
                let (door, room) = (Arc::clone(&door), Arc::clone(&room));
                tokio::spawn(async move {
                    // The slow ones are dropped by then.
                    let permit = timeout(2 * REQUEST_TIMEOUT, room.acquire_owned()).await;
                    drop(place);
                    match permit {
                        Ok(Ok(_permit)) => serve(stream, door).await,
                        _ => refuse(stream).await,
                    }
                });
            }
            // The client has left, or too many files are open.
            Err(_) => sleep(Duration::from_millis(50)).await,
        }
    }
}

/// Answers a connection for which there is no room.
async fn refuse(mut stream: TcpStream) {
    // It may have left.
    let _ = timeout(REQUEST_TIMEOUT, stream.write_all(FULL.as_bytes())).await;
}

/// Serves one connection until it ends.
async fn serve(stream: TcpStream, door: Arc<Door>) {
    let _ = stream.set_nodelay(true);
    let service = service_fn(move |request| {
        let door = Arc::clone(&door);
        async move { Ok::<_, Infallible>(door.respond(request).await) }
    });
    // It fails if the client does not speak HTTP, is too slow, or leaves.
    let _ = http1::Builder::new()
        .timer(TokioTimer::new())
        .header_read_timeout(REQUEST_TIMEOUT)
        .max_buf_size(16 << 10)
        .serve_connection(TokioIo::new(stream), service)
        .await;
}

impl Door {
    async fn respond(&self, request: Request<Incoming>) -> Response<Body> {
        let Some(name) = self.name(&request) else { return nothing() };
        match (request.method(), name) {
            (&Method::GET, "events") => response("text/event-stream", self.events()),
            (&Method::POST, "messages") if is_json(request.headers()) => {
                let message = Limited::new(request.into_body(), MAX_BYTES).collect();
                match timeout(REQUEST_TIMEOUT, message).await {
                    Ok(Ok(message)) => {
                        response("application/json", full((self.site.answer)(message.to_bytes()).await))
                    }
                    _ => nothing(),
                }
            }
            (&Method::GET, name) => match self.site.files.iter().find(|file| file.name == name) {
                Some(file) => response(file.media_type, full(file.content)),
                None => nothing(),
            },
            _ => nothing(),
        }
    }

    /// Returns the path of a request, without the secret; `None` if it must not be answered.
    fn name<'a>(&self, request: &'a Request<Incoming>) -> Option<&'a str> {
        let headers = request.headers();
        // A page elsewhere that has its own name lead here sends that name.
        let is_for_us =
            only(headers, &header::HOST).ok()? == Some(&self.host) && request.uri().authority().is_none();
        // Browsers send it with all but simple requests of the same origin.
        let is_own = match only(headers, &header::ORIGIN).ok()? {
            Some(origin) => origin == self.origin,
            None => request.method() == Method::GET,
        };
        let is_from_own = matches!(only(headers, &SITE).ok()?, None | Some("none" | "same-origin"));
        let (secret, name) = request.uri().path().strip_prefix('/')?.split_once('/')?;
        let is_known = is_equal(secret.as_bytes(), self.secret.as_bytes());
        (is_for_us && is_own && is_from_own && is_known && request.uri().query().is_none()).then_some(name)
    }

    /// Events from now on, after the first one.
    fn events(&self) -> Body {
        let receiver = self.events.subscribe();
        let first = frame(&(self.site.greet)());
        // A page that has missed events is disconnected, and connects again.
        let later = stream::unfold(receiver, async |mut receiver| {
            let event = receiver.recv().await.ok()?;
            Some((event, receiver))
        });
        let events = stream::iter([first]).chain(later);
        StreamBody::new(events.map(|event| Ok(Frame::data(event)))).boxed_unsync()
    }
}

/// Says from which site a request comes.
const SITE: HeaderName = HeaderName::from_static("sec-fetch-site");

/// A header that is there several times, or is not text.
struct Ambiguous;

/// The value of a header, if there is one.
fn only<'a>(headers: &'a HeaderMap, name: &HeaderName) -> Result<Option<&'a str>, Ambiguous> {
    let mut values = headers.get_all(name).iter();
    match (values.next(), values.next()) {
        (None, _) => Ok(None),
        (Some(value), None) => value.to_str().map(Some).map_err(|_| Ambiguous),
        (Some(_), Some(_)) => Err(Ambiguous),
    }
}

/// Other pages may not send this type without being allowed to.
fn is_json(headers: &HeaderMap) -> bool {
    matches!(only(headers, &header::CONTENT_TYPE), Ok(Some("application/json")))
}

/// Compares in a time that does not depend on the content.
fn is_equal(one: &[u8], other: &[u8]) -> bool {
    one.len() == other.len() && one.iter().zip(other).fold(0, |all, (one, other)| all | (one ^ other)) == 0
}

/// An event as a page receives it.
fn frame(event: &[u8]) -> Bytes {
    Bytes::from([b"data: ", event, b"\n\n"].concat())
}

fn full(content: impl Into<Bytes>) -> Body {
    Full::new(content.into()).boxed_unsync()
}

fn response(media_type: &'static str, body: Body) -> Response<Body> {
    let mut response = with_headers(Response::new(body));
    response.headers_mut().insert(header::CONTENT_TYPE, HeaderValue::from_static(media_type));
    response
}

fn nothing() -> Response<Body> {
    let mut response = with_headers(Response::new(full("")));
    *response.status_mut() = StatusCode::NOT_FOUND;
    // The rest of a body that is too long or too slow is not read.
    response.headers_mut().insert(header::CONNECTION, HeaderValue::from_static("close"));
    response
}

fn with_headers(mut response: Response<Body>) -> Response<Body> {
    for (name, value) in HEADERS {
        response.headers_mut().insert(name, HeaderValue::from_static(value));
    }
    response
}
