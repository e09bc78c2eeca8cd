//! The clock of a scene, which counts whole ticks independently of frames.

use crate::error::SceneError;
use pendulum_core::time::Time;

/// The time of a scene: a whole number of ticks, and the sum of frame times.
///
/// Frame times are summed in two words, so that the number of ticks depends only on their sum.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Clock {
    /// The number of ticks per second.
    rate: f64,
    /// The number of computed ticks.
    tick: i64,
    /// The sum of the frame times.
    asked: Time,
    /// The tick at which this sum began.
    origin: i64,
}

/// The tolerance in ticks by which a sum of frame times may fall short of a whole tick: thirds and
/// twenty-fourths of a second are not binary fractions, but 24 twenty-fourths must add up to a
/// second.
const SLACK: f64 = 1e-6;

/// Returns the time of a tick if `kink` follows it within rounding, otherwise `kink`.
///
/// Times of files are often `f32`, and kinks of later periods are sums: a kink that is meant to be
/// at a tick may follow it. In the next tick, the ends of a loop would lie on different sides of
/// it. The rounding of `f32` is limited to a thousandth of a tick, so that kinks of long scenes
/// keep their times.
pub(crate) fn at_tick(kink: f64, rate: f64) -> f64 {
    const ROUNDING: f64 = 1.2e-7;
    let tick = (kink * rate).floor() / rate;
    let slack = (ROUNDING * kink.abs()).max(SLACK / rate).min(1e-3 / rate);
    let late = kink - tick;
    if 0.0 < late && late <= slack { tick } else { kink }
}

impl Clock {
    pub(crate) fn new(rate: f64) -> Result<Self, SceneError> {
        if (1e-3..=1e6).contains(&rate) {
            Ok(Self { rate, tick: 0, asked: Time::new(0.0), origin: 0 })
        } else {
            Err(SceneError::Setting {
                name: "rate",
                value: rate,
                required: "between 0.001 and a million ticks a second",
            })
        }
    }

    pub(crate) fn tick(&self) -> i64 {
        self.tick
    }

    /// Returns the length of a tick in seconds.
    pub(crate) fn step(&self) -> f64 {
        1.0 / self.rate
    }

    /// Returns the time of a tick as the nearest `f64`.
    ///
    /// The times of ticks have a single word, so that a kink at a tick has exactly the same time.
    pub(crate) fn time(&self, tick: i64) -> f64 {
        tick as f64 / self.rate
    }

    /// Returns the last tick that begins before `t`: a kink at the end of a tick belongs to this
    /// tick.
    pub(crate) fn last_before(&self, t: f64) -> i64 {
        let guess = (t * self.rate).floor();
        if 9e18 <= guess {
            return i64::MAX;
        }
        // The guess is one too large if `t` is the time of a tick or if the product was rounded up.
        let tick = guess as i64;
        if t <= self.time(tick) { tick - 1 } else { tick }
    }

    /// Returns the number of ticks per second.
    pub(crate) fn rate(&self) -> f64 {
        self.rate
    }

    /// Returns the time that is `fraction` of a tick after `tick`.
    pub(crate) fn within(&self, tick: i64, fraction: f64) -> Time {
        if fraction == 0.0 {
            Time::new(self.time(tick))
        } else if fraction == 1.0 {
            Time::new(self.time(tick + 1))
        } else {
            Time::new(self.time(tick)) + fraction * self.step()
        }
    }

    /// Adds a frame time of `dt` seconds, at most `limit`. Returns the number of ticks that are due
    /// and the seconds dropped.
    pub(crate) fn ask(&mut self, dt: f64, limit: f64) -> Result<(u64, f64), SceneError> {
        if !(0.0..f64::INFINITY).contains(&dt) {
            return Err(SceneError::FrameTime(dt));
        }
        let taken = if limit < dt { limit } else { dt };
        self.asked += taken;
        let due = (self.asked.to_f64() * self.rate + SLACK).floor() as i64 + self.origin;
        Ok(((due - self.tick).max(0) as u64, dt - taken))
    }

    /// Returns the time up to which frames have been requested, before `ticks` ticks that are due
    /// are computed. Within the tolerance of [`ask`](Self::ask), it is the time of a tick.
    pub(crate) fn asked(&self, ticks: u64) -> f64 {
        let tick = self.tick + ticks as i64;
        let part = self.asked.to_f64() * self.rate - (tick - self.origin) as f64
            + self.asked.low() * self.rate;
        let part = if part <= SLACK { 0.0 } else { part };
        self.time(tick) + part * self.step()
    }

    /// Counts ticks that have been computed.
    pub(crate) fn passed(&mut self, ticks: u64) {
        self.tick += ticks as i64;
    }

    /// Moves the clock to `tick`, without a fraction of a tick.
    pub(crate) fn jump(&mut self, tick: i64) {
        (self.tick, self.origin, self.asked) = (tick, tick, Time::new(0.0));
    }

    /// Shifts the time requested by frames by whole ticks, before ticks that no frame has
    /// requested.
    pub(crate) fn shift(&mut self, ticks: i64) {
        self.origin += ticks;
    }

    /// Returns the fraction of the next tick that frames have requested, in [0, 1).
    pub(crate) fn fraction(&self) -> f64 {
        let ticks = self.asked.to_f64() * self.rate - (self.tick - self.origin) as f64
            + self.asked.low() * self.rate;
        if ticks <= 0.0 {
            0.0
        } else if ticks < 1.0 {
            ticks
        } else {
            1.0f64.next_down()
        }
    }

    /// Returns the tick, the origin and both words of the sum of frame times.
    pub(crate) fn state(&self) -> (i64, i64, [f64; 2]) {
        (self.tick, self.origin, [self.asked.to_f64(), self.asked.low()])
    }

    pub(crate) fn restore(&mut self, (tick, origin, asked): (i64, i64, [f64; 2])) {
        (self.tick, self.origin, self.asked) = (tick, origin, Time::new(asked[0]) + asked[1]);
    }
}

#[cfg(test)]
mod tests {
    use super::Clock;

    #[test]
    fn frames_make_whole_seconds() {
        for frames in [24, 30, 60, 144, 240, 1000] {
            let mut clock = Clock::new(240.0).unwrap();
            for _ in 0..3600 * frames {
                let (ticks, dropped) = clock.ask(1.0 / f64::from(frames), 1.0).unwrap();
                clock.passed(ticks);
                assert_eq!(dropped, 0.0);
            }
            assert_eq!(clock.tick(), 240 * 3600, "{frames}");
        }
    }

    #[test]
    fn what_is_too_long_is_dropped_and_what_is_no_time_refused() {
        let mut clock = Clock::new(100.0).unwrap();
        assert_eq!(clock.ask(3.0, 1.0).unwrap(), (100, 2.0));
        assert_eq!(clock.ask(0.0, 1.0).unwrap(), (100, 0.0));
        for dt in [-0.1, f64::NAN, f64::INFINITY] {
            assert!(clock.ask(dt, 1.0).is_err());
        }
        assert!(Clock::new(0.0).is_err() && Clock::new(f64::NAN).is_err());
    }

    #[test]
    fn what_is_left_over_is_a_part_of_a_tick() {
        let mut clock = Clock::new(60.0).unwrap();
        let (ticks, _) = clock.ask(2.5 / 60.0, 1.0).unwrap();
        clock.passed(ticks);
        assert_eq!(ticks, 2);
        assert!((clock.fraction() - 0.5).abs() < 1e-12);
    }
}
