//! What goes over the network: nothing, unless it is asked for.

use std::{
    env,
    process::{Command, Output},
};

use super::{Stage, output::stderr};

/// A network of its own, with loopback and an Ethernet that leads nowhere. It needs root, and `ip` of iproute2.
pub(crate) struct OwnNetwork {
    name: String,
}

/// The interface besides loopback.
const ETHERNET: &str = "outside";

impl OwnNetwork {
    /// # Errors
    /// Returns the cause where there are no rights.
    pub(crate) fn new(name: &str) -> Result<Self, String> {
        let name = format!("toposlam-{name}-{}", std::process::id());
        let made = Command::new("ip").args(["netns", "add", &name]).output();
        let made = made.map_err(|error| error.to_string())?;
        if !made.status.success() {
            return Err(stderr(&made));
        }
        let network = Self { name };
        network.set_up();
        Ok(network)
    }

    fn set_up(&self) {
        let peer = format!("{ETHERNET}-peer");
        // The kernel itself sends nothing without IPv6.
        self.run(&["sh", "-c", "echo 1 > /proc/sys/net/ipv6/conf/default/disable_ipv6"]);
        self.run(&["ip", "link", "set", "lo", "up"]);
        self.run(&["ip", "link", "add", ETHERNET, "type", "veth", "peer", "name", &peer]);
        self.run(&["ip", "address", "add", "10.99.0.1/24", "dev", ETHERNET]);
        self.run(&["ip", "link", "set", ETHERNET, "up"]);
        self.run(&["ip", "link", "set", &peer, "up"]);
        self.run(&["ip", "route", "add", "default", "dev", ETHERNET]);
    }

    fn run(&self, arguments: &[&str]) -> Output {
        let output = self.command(arguments[0]).args(&arguments[1..]).output().unwrap();
        assert!(output.status.success(), "{arguments:?}: {}", stderr(&output));
        output
    }

    /// A program in this network.
    pub(crate) fn command(&self, program: &str) -> Command {
        let mut command = Command::new("ip");
        command.args(["netns", "exec", &self.name, program]);
        command
    }

    /// The number of packets that were sent beyond loopback.
    pub(crate) fn sent(&self) -> u64 {
        let path = format!("/sys/class/net/{ETHERNET}/statistics/tx_packets");
        let output = self.run(&["cat", &path]);
        String::from_utf8_lossy(&output.stdout).trim().parse().unwrap()
    }
}

impl Drop for OwnNetwork {
    fn drop(&mut self) {
        let _ = Command::new("ip").args(["netns", "delete", &self.name]).status();
    }
}

#[test]
fn packets_leave_the_machine_only_with_the_option_network() {
    let stage = Stage::new("network");
    let Some(network) = &stage.network else {
        assert_ne!(env::var("TOPOSLAM_ROS").as_deref(), Ok("required"), "ip netns does not work");
        eprintln!("skipped: `ip netns` needs iproute2 and root");
        return;
    };
    let looks_for_a_robot = |more: &[&str]| {
        let output = stage.drive(more).ends_within(60);
        assert_eq!(output.status.code(), Some(2), "{}", stderr(&output));
        assert!(stderr(&output).contains("nobody publishes /odom"), "{}", stderr(&output));
    };
    looks_for_a_robot(&[]);
    assert_eq!(network.sent(), 0, "packets on {ETHERNET} of a run on loopback");
    looks_for_a_robot(&["--network"]);
    assert!(network.sent() > 0, "the robot is looked for on the network");
}
