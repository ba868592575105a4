//! The addresses of the processes of a cluster.

use thiserror::Error;

/// The address of each process, `host:port`, in the order of the processes.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Hosts(Vec<String>);

/// The error for a text that is not a list of addresses.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
pub enum HostsError {
    #[error("line {line}: `{text}` is not an address; write host:port")]
    NotAnAddress { line: usize, text: String },
    #[error("line {line}: {address} is listed twice")]
    Twice { line: usize, address: String },
    #[error("there is no address; write host:port for each process, one a line")]
    Empty,
}

impl Hosts {
    /// Reads one address a line. Empty lines, and what follows a `#`, are skipped.
    ///
    /// # Errors
    /// Returns an error if a line is not an address, if one is listed twice, or if there is none.
    pub fn parse(text: &str) -> Result<Self, HostsError> {
        let mut addresses: Vec<String> = Vec::new();
        for (line, text) in (1..).zip(text.lines()) {
            let text = text.split('#').next().unwrap_or_default().trim();
            if text.is_empty() {
                continue;
            }
            if !is_address(text) {
                return Err(HostsError::NotAnAddress { line, text: text.to_owned() });
            }
            if addresses.iter().any(|address| address == text) {
                return Err(HostsError::Twice { line, address: text.to_owned() });
            }
            addresses.push(text.to_owned());
        }
        if addresses.is_empty() { Err(HostsError::Empty) } else { Ok(Self(addresses)) }
    }

    pub fn count(&self) -> usize {
        self.0.len()
    }

    /// The address of a process, and its number: `process 1 (host:port)`.
    pub fn name(&self, process: usize) -> String {
        format!("process {process} ({})", self.address(process))
    }

    /// The address of a process; empty if there is no such process.
    pub(crate) fn address(&self, process: usize) -> &str {
        self.0.get(process).map_or("", String::as_str)
    }

    pub(crate) fn all(&self) -> String {
        self.0.join(" ")
    }
}

fn is_address(text: &str) -> bool {
    text.rsplit_once(':').is_some_and(|(host, port)| {
        let is_port = port.parse().is_ok_and(|port: u16| port > 0);
        is_port && !host.is_empty() && !host.contains(char::is_whitespace)
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_address_is_a_host_and_a_port() {
        let text = "# the lab\n10.0.0.1:7700\n\n node-2:7700  # upstairs\r\n[::1]:7701\n";
        let hosts = Hosts::parse(text).unwrap();
        assert_eq!(hosts.count(), 3);
        assert_eq!(hosts.name(1), "process 1 (node-2:7700)");
        assert_eq!(hosts.address(2), "[::1]:7701");
        for wrong in ["node", "node:", ":7700", "node:0", "node:70000", "a node:7700"] {
            let text = format!("node:1\n{wrong}");
            let expected = HostsError::NotAnAddress { line: 2, text: wrong.to_owned() };
            assert_eq!(Hosts::parse(&text), Err(expected));
        }
        let twice = HostsError::Twice { line: 3, address: "a:1".to_owned() };
        assert_eq!(Hosts::parse("a:1\nb:1\na:1"), Err(twice));
        assert_eq!(Hosts::parse(" \n# none\n"), Err(HostsError::Empty));
    }
}
