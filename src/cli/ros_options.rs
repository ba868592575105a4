//! Where the topics of a robot are: at a master of ROS 1, or in a domain of ROS 2.

#[cfg(any(feature = "ros1", feature = "ros2"))]
use std::{env, time::Duration};

use clap::ValueEnum;
#[cfg(any(feature = "ros1", feature = "ros2"))]
use toposlam_logs::record::RunObserver;
#[cfg(any(feature = "ros1", feature = "ros2"))]
use toposlam_robot::{
    live::{LiveRobot, LiveSensor, RobotTopics, ServedRobot},
    robot::RobotError,
};

use super::CliError;

#[derive(clap::Args, Debug)]
#[command(next_help_heading = "ROS")]
pub(super) struct RosOptions {
    /// Speak ROS 1, with the master at this address, as in http://127.0.0.1:11311
    #[arg(long, value_name = "URI")]
    ros: Option<String>,
    /// Speak ROS 2 over DDS, in the domain of the variable ROS_DOMAIN_ID, or 0
    #[arg(long, conflicts_with = "ros")]
    ros2: bool,
    /// With --ros2: the namespace of the robot's topics, as in robot1
    #[arg(
        long,
        value_name = "NAME",
        requires = "ros2",
        default_value = "",
        hide_default_value = true
    )]
    namespace: String,
    /// With --ros2: use the network, not only this machine
    #[arg(long, requires = "ros2")]
    network: bool,
    /// With --ros2: the type of the commands to the wheels, Twist or TwistStamped [default: what the robot reads; the
    /// simulated robot reads Twist]
    #[arg(
        long,
        value_name = "TYPE",
        requires = "ros2",
        ignore_case = true,
        hide_possible_values = true
    )]
    cmd_vel_type: Option<CommandType>,
    /// With --ros2: let the tools of this distribution list the node, as in `ros2 node list`: humble, iron, jazzy, kilted or
    /// rolling [default: topics only]
    #[arg(long, value_name = "NAME", requires = "ros2", hide_possible_values = true)]
    ros_distro: Option<Distribution>,
}

/// A distribution of ROS 2.
#[derive(Clone, Copy, Debug, ValueEnum)]
enum Distribution {
    Humble,
    Iron,
    Jazzy,
    Kilted,
    Rolling,
}

/// The type of the commands to the wheels.
#[derive(Clone, Copy, Debug, ValueEnum)]
enum CommandType {
    #[value(name = "Twist")]
    Twist,
    #[value(name = "TwistStamped")]
    TwistStamped,
}

/// The largest number of a domain: the ports of others are those of other programs.
#[cfg(any(feature = "ros1", feature = "ros2"))]
const MOST_DOMAINS: u16 = 232;

/// A robot behind topics, and what publishes its run: in ROS 1, nothing does.
#[cfg(any(feature = "ros1", feature = "ros2"))]
type ConnectedRobot = (LiveRobot, Box<dyn RunObserver>);

impl RosOptions {
    #[cfg(any(feature = "ros1", feature = "ros2"))]
    pub(super) fn is_given(&self) -> bool {
        self.ros2 || self.ros.is_some()
    }

    /// Checks that this program speaks the ROS of the robot, if one is given.
    pub(super) fn check_build(&self) -> Result<(), CliError> {
        let is_built = if self.ros.is_some() {
            cfg!(feature = "ros1")
        } else {
            cfg!(feature = "ros2") || !self.ros2
        };
        if is_built { Ok(()) } else { Err(self.missing()) }
    }

    /// Where the topics are, in words.
    #[cfg(any(feature = "ros1", feature = "ros2"))]
    pub(super) fn place(&self) -> Result<String, CliError> {
        match &self.ros {
            Some(master) => Ok(format!("at {master}")),
            None if self.namespace.is_empty() => Ok(format!("in domain {}", domain()?)),
            None => Ok(format!("in domain {}, namespace {}", domain()?, self.namespace)),
        }
    }

    /// The option for the place of the topics.
    #[cfg(any(feature = "ros1", feature = "ros2"))]
    fn option(&self) -> &'static str {
        if self.ros.is_some() { "--ros" } else { "--ros2" }
    }

    /// The robot behind topics, and an observer that publishes its run; `None` if the program is to stop before there is one.
    ///
    /// # Errors
    /// Returns an error if there is no robot, or if this program does not speak its ROS.
    #[cfg(any(feature = "ros1", feature = "ros2"))]
    #[cfg_attr(not(feature = "ros2"), expect(unused_variables, reason = "ROS 1 has no such time"))]
    pub(super) fn connect(
        &self,
        topics: &RobotTopics,
        sensor: LiveSensor,
        sim_time: bool,
        patience: Duration,
        stop: fn() -> bool,
    ) -> Result<Option<ConnectedRobot>, CliError> {
        let connected = match &self.ros {
            #[cfg(feature = "ros1")]
            Some(master) => toposlam_robot::ros1::connect(master, topics, sensor, patience, stop)
                .map(|robot| (robot, Box::new(()) as _)),
            #[cfg(feature = "ros2")]
            None => {
                let settings = toposlam_robot::ros2::DriveSettings {
                    sensor,
                    wheels_type: self.command_type(),
                    sim_time,
                    patience,
                    stop,
                    abort: super::progress::request_stop,
                };
                let connected =
                    toposlam_robot::ros2::connect(&self.ros2_domain()?, topics, &settings);
                connected.map(|(robot, run)| (robot, Box::new(run) as _))
            }
            #[cfg(not(all(feature = "ros1", feature = "ros2")))]
            _ => return Err(self.missing()),
        };
        match connected {
            Ok(robot) => Ok(Some(robot)),
            Err(RobotError::Stopped) => Ok(None),
            Err(error) => Err(CliError::at(self.option(), error)),
        }
    }

    /// The topics of a simulated robot.
    ///
    /// # Errors
    /// Returns an error if there is no master, if DDS cannot be used, or if this program does not speak this ROS.
    #[cfg(any(feature = "ros1", feature = "ros2"))]
    pub(super) fn serve(&self, topics: &RobotTopics) -> Result<Box<dyn ServedRobot>, CliError> {
        let at = |error| CliError::at(self.option(), error);
        match &self.ros {
            #[cfg(feature = "ros1")]
            Some(master) => {
                let served = toposlam_robot::ros1::MasterTopics::new(master, topics);
                Ok(Box::new(served.map_err(at)?))
            }
            #[cfg(feature = "ros2")]
            None => {
                use toposlam_robot::ros2::{DomainTopics, WheelsType};
                let kind = self.command_type().unwrap_or(WheelsType::Twist);
                let served = DomainTopics::new(&self.ros2_domain()?, topics, kind);
                Ok(Box::new(served.map_err(at)?))
            }
            #[cfg(not(all(feature = "ros1", feature = "ros2")))]
            _ => Err(self.missing()),
        }
    }

    #[cfg(feature = "ros2")]
    fn ros2_domain(&self) -> Result<toposlam_robot::ros2::RobotDomain, CliError> {
        use toposlam_robot::ros2::{RobotDomain, RosDistro};
        let (namespace, network) = (self.namespace.clone(), self.network);
        let distro = self.ros_distro.map(|distribution| match distribution {
            Distribution::Humble => RosDistro::Humble,
            _ => RosDistro::IronOrLater,
        });
        Ok(RobotDomain { number: domain()?, namespace, network, distro })
    }

    #[cfg(feature = "ros2")]
    fn command_type(&self) -> Option<toposlam_robot::ros2::WheelsType> {
        use toposlam_robot::ros2::WheelsType;
        self.cmd_vel_type.map(|kind| match kind {
            CommandType::Twist => WheelsType::Twist,
            CommandType::TwistStamped => WheelsType::TwistStamped,
        })
    }

    /// The error of a program that does not speak this ROS.
    pub(super) fn missing(&self) -> CliError {
        let (option, version) = if self.ros.is_some() { ("--ros", 1) } else { ("--ros2", 2) };
        let cause = format!(
            "this program was built without ROS {version}; to add it, run \
             cargo build --release --features ros{version}"
        );
        CliError::at(option, cause)
    }
}

/// The domain of ROS 2.
#[cfg(any(feature = "ros1", feature = "ros2"))]
fn domain() -> Result<u16, CliError> {
    let Some(text) = env::var_os("ROS_DOMAIN_ID").filter(|text| !text.is_empty()) else {
        return Ok(0);
    };
    let number = text.to_str().and_then(|text| text.trim().parse().ok());
    number.filter(|&number| number <= MOST_DOMAINS).ok_or_else(|| {
        let cause = format!("expected a number from 0 to {MOST_DOMAINS}, found {}", text.display());
        CliError::at("ROS_DOMAIN_ID", cause)
    })
}
