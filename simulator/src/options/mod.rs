//! Options of programs for a simulated robot: what it senses with, what its building looks like.

pub mod appearance;
pub mod robot_sensor;

use crate::MotionNoise;

/// Parses the noise of a simulated robot, as a multiple of the default.
pub fn noise(text: &str) -> Result<f64, String> {
    let most = MotionNoise::MOST;
    match text.parse() {
        Ok(times) if (0.0..=most).contains(&times) => Ok(times),
        Ok(times) if times > most => {
            Err(format!("with more than {most} times the default noise a robot cannot navigate"))
        }
        _ => Err(format!("write a number from 0 to {most}")),
    }
}
