//! The server as a process: on standard input and output, or on a socket.

use std::fs::File;
use std::io;
use std::net::{Ipv4Addr, TcpStream};
use std::process::ExitCode;

use crate::launch::Launch;
use crate::message_loop::serve;

/// The most that Linux allows any process by default.
#[cfg(target_os = "linux")]
const PIPE_SIZE: usize = 1 << 20;

/// Serves one client on standard input and output; the exit code is the protocol's: success only after `shutdown`
/// and `exit`.
///
/// # Errors
///
/// If standard input or output is closed, or a thread cannot be started.
pub(crate) fn run_stdio(launch: Launch) -> io::Result<ExitCode> {
    let (input, output) = stdio()?;
    serve(input, output, launch).map(ExitCode::from)
}

/// Serves the client that listens on a port of this machine; the exit code as for [`run_stdio`].
///
/// # Errors
///
/// If nothing listens there, or a thread cannot be started.
pub(crate) fn run_socket(port: u16, launch: Launch) -> io::Result<ExitCode> {
    let stream = TcpStream::connect((Ipv4Addr::LOCALHOST, port))?;
    // Messages are small and waited for: they must not be delayed to fill packets.
    stream.set_nodelay(true)?;
    let input = stream.try_clone()?;
    serve(input, stream, launch).map(ExitCode::from)
}

/// Standard input and output as plain files: those of the standard library would flush at each line break.
#[cfg(unix)]
fn stdio() -> io::Result<(File, File)> {
    use std::os::fd::AsFd;
    let input = io::stdin().as_fd().try_clone_to_owned()?;
    let output = io::stdout().as_fd().try_clone_to_owned()?;
    #[cfg(target_os = "linux")]
    for pipe in [&input, &output] {
        // Megabytes then pass in a few pieces instead of hundreds, each of which is a context switch. This fails for
        // anything but a pipe, and where the limit is lower; then the size stays as it is.
        let _ = rustix::pipe::fcntl_setpipe_size(pipe, PIPE_SIZE);
    }
    Ok((input.into(), output.into()))
}

/// Standard input and output as plain files: those of the standard library would flush at each line break.
#[cfg(windows)]
fn stdio() -> io::Result<(File, File)> {
    use std::os::windows::io::AsHandle;
    let input = io::stdin().as_handle().try_clone_to_owned()?;
    let output = io::stdout().as_handle().try_clone_to_owned()?;
    Ok((input.into(), output.into()))
}
