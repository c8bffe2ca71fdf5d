//! The house style of benches: jobs measured in turn in one run, a table of the least time of each,
//! and ratios to reference jobs of the same run.
//!
//! Every bench includes this file with `#[path]`. Time is the thread's own on the processor, page faults
//! of new memory included, and the wall clock's for jobs that have threads of their own; the least of many runs is what the code costs, and all above it is other load
//! on the machine. Jobs take turns, so that a busy moment spoils one run of
//! each and not all runs of one.
#![allow(clippy::print_stdout, reason = "a bench prints its table")]

use std::time::{Duration, Instant};

use cpu_time::ThreadTime;

/// How long a job has its turn at least.
const SHORTEST_TURN: Duration = Duration::from_millis(2);

/// How long a reading of the clock spans at least, so that reading it costs nothing beside.
const SHORTEST_READING_SECS: f64 = 50e-6;

/// How a job's time is told.
#[derive(Clone, Copy, Debug)]
#[allow(dead_code, reason = "each bench uses the unit of its subject")]
pub(crate) enum Unit {
    /// Nanoseconds for each of so many things a run.
    NanosecondsPer(&'static str),
    /// 10^6 bytes a second, of so many bytes a run.
    MegabytesPerSecond,
}

struct Job<'a> {
    name: String,
    amount: f64,
    is_reference: bool,
    /// Whether other threads do the work, which the thread's own time would not show.
    is_threaded: bool,
    work: Box<dyn FnMut() + 'a>,
    least_secs: f64,
    /// How many runs there are to a reading of the clock.
    runs: u32,
}

/// Jobs that are measured together.
pub(crate) struct Table<'a> {
    title: String,
    unit: Unit,
    jobs: Vec<Job<'a>>,
}

impl<'a> Table<'a> {
    pub(crate) fn new(title: impl Into<String>, unit: Unit) -> Self {
        Self {
            title: title.into(),
            unit,
            jobs: Vec::new(),
        }
    }

    /// Adds a job that does `amount` of the unit's things, or bytes, in each run.
    pub(crate) fn job(
        &mut self,
        name: impl Into<String>,
        amount: usize,
        work: impl FnMut() + 'a,
    ) -> &mut Self {
        self.jobs.push(Job {
            name: name.into(),
            amount: f64::from(u32::try_from(amount).expect("a run is not that long")),
            is_reference: false,
            is_threaded: false,
            work: Box::new(work),
            least_secs: f64::INFINITY,
            runs: 1,
        });
        self
    }

    /// Adds a job like [`job`](Self::job) that gets a column: how many times as fast the others are.
    pub(crate) fn reference(
        &mut self,
        name: impl Into<String>,
        amount: usize,
        work: impl FnMut() + 'a,
    ) -> &mut Self {
        self.job(name, amount, work);
        self.jobs.last_mut().expect("a job was added").is_reference = true;
        self
    }

    /// Adds a job like [`job`](Self::job) whose work is done by threads of its own: its time is the wall clock's.
    #[allow(dead_code, reason = "few benches have such jobs")]
    pub(crate) fn threaded_job(
        &mut self,
        name: impl Into<String>,
        amount: usize,
        work: impl FnMut() + 'a,
    ) -> &mut Self {
        self.job(name, amount, work);
        self.jobs.last_mut().expect("a job was added").is_threaded = true;
        self
    }

    /// Runs all jobs in turn for about so long, each in three turns at least, and prints the table.
    pub(crate) fn measure(&mut self, time: Duration) {
        let start = Instant::now();
        let mut rounds = 0;
        while rounds < 3 || start.elapsed() < time {
            for job in &mut self.jobs {
                job.take_turn();
            }
            rounds += 1;
        }
        self.print(rounds);
    }

    fn print(&self, rounds: usize) {
        println!("\n{}; least of {rounds} turns", self.title);
        let unit = match self.unit {
            Unit::NanosecondsPer(thing) => format!("ns/{thing}"),
            Unit::MegabytesPerSecond => "MB/s".to_owned(),
        };
        let references: Vec<&Job<'_>> = self.jobs.iter().filter(|job| job.is_reference).collect();
        print!("{:<52}{unit:>14}", "");
        for reference in &references {
            // The name up to its first comma is enough for a column.
            let name = reference.name.split(',').next().unwrap_or_default();
            print!("  x {name}");
        }
        println!();
        for job in &self.jobs {
            let figure = match self.unit {
                Unit::NanosecondsPer(_) => format!("{:.2}", job.secs_per_unit() * 1e9),
                Unit::MegabytesPerSecond => format!("{:.0}", 1e-6 / job.secs_per_unit()),
            };
            print!("{:<52}{figure:>14}", job.name);
            for reference in &references {
                let width = reference.name.split(',').next().unwrap_or_default().len() + 4;
                let ratio = reference.secs_per_unit() / job.secs_per_unit();
                print!("{ratio:>width$.2}");
            }
            println!();
        }
    }
}

impl Job<'_> {
    /// The first run of a turn is not counted: it pays for what the job before it did to the caches, and to memory, which
    /// a virtual machine may have given back to its host. Short jobs then run a few times in a row, and several times to
    /// a reading of the clock.
    fn take_turn(&mut self) {
        (self.work)();
        let turn = Instant::now();
        while turn.elapsed() < SHORTEST_TURN {
            let (start, started) = (ThreadTime::now(), Instant::now());
            for _ in 0..self.runs {
                (self.work)();
            }
            let secs = match self.is_threaded {
                true => started.elapsed().as_secs_f64(),
                false => start.elapsed().as_secs_f64(),
            };
            self.least_secs = self.least_secs.min(secs / f64::from(self.runs));
            if secs < SHORTEST_READING_SECS {
                self.runs *= 2;
            }
        }
    }

    fn secs_per_unit(&self) -> f64 {
        self.least_secs / self.amount
    }
}

/// How long to measure a table: the first argument that is a number, in seconds, otherwise 3.
pub(crate) fn time_asked() -> Duration {
    let seconds = std::env::args().find_map(|word| word.parse().ok());
    Duration::from_secs_f64(seconds.unwrap_or(3.0))
}
