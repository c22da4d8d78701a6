//! A viewer that shows a run while it goes on: messages go to it as they would go to a file.

use ::rerun::log::LogMsg;
use ::rerun::sink::{GrpcSink, LogSink};
use std::error::Error;
use std::net::{SocketAddr, TcpStream};
use std::time::Duration;

/// Time that a viewer has to take what it is sent; one that takes longer is gone, and the run goes on without it.
const PATIENCE: Duration = Duration::from_secs(2);
/// Time in which a program on this machine answers.
const ANSWER: Duration = Duration::from_millis(300);

/// A viewer on this machine.
pub struct Live {
    address: SocketAddr,
    sink: Option<GrpcSink>,
}

/// Whether something listens at a port of this machine.
pub fn is_there(port: u16) -> bool {
    TcpStream::connect_timeout(&SocketAddr::from(([127, 0, 0, 1], port)), ANSWER).is_ok()
}

impl Live {
    /// The viewer at a port of this machine.
    ///
    /// # Errors
    /// None listens there.
    pub fn connect(port: u16) -> Result<Self, Box<dyn Error>> {
        let address = SocketAddr::from(([127, 0, 0, 1], port));
        TcpStream::connect_timeout(&address, ANSWER)?;
        let uri = format!("rerun+http://{address}/proxy").parse()?;
        Ok(Live { address, sink: Some(GrpcSink::new(uri)) })
    }

    pub(super) fn send(&mut self, message: &LogMsg) {
        if let Some(sink) = &self.sink {
            sink.send(message.clone());
        }
    }

    /// What was sent has arrived; if not, nothing more is sent.
    pub(super) fn flush(&mut self) {
        let is_lost = self.sink.as_ref().is_some_and(|sink| {
            TcpStream::connect_timeout(&self.address, ANSWER).is_err() || sink.flush_blocking(PATIENCE).is_err()
        });
        if is_lost {
            self.sink = None;
        }
    }
}
