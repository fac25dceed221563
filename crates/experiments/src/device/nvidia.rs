//! What `nvidia-smi` says of the device while a part runs; nothing on a machine without it.

use std::path::Path;
use std::process::Command;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{self, Receiver};
use std::time::Duration;

use serde::{Deserialize, Serialize};

/// What a device had and did during a part, by a sample every half second or so. `null` is what the tool
/// does not know.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct DeviceUse {
    /// How many samples.
    pub samples: usize,
    /// Memory in use by all processes, MiB.
    pub memory_mib: Option<Span>,
    /// Clock of the multiprocessors, MHz.
    pub clock_mhz: Option<Span>,
    /// Clock of the memory, MHz.
    pub memory_clock_mhz: Option<Span>,
    /// Temperature, °C.
    pub celsius: Option<Span>,
    /// Power drawn, W.
    pub watts: Option<Span>,
}

/// The least and the most of some samples.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Span {
    /// The least.
    pub least: f64,
    /// The most.
    pub most: f64,
}

/// What is asked for in each sample, in the order of [`Sample`].
const QUERY: &str = "memory.used,clocks.sm,clocks.mem,temperature.gpu,power.draw";
const INTERVAL: Duration = Duration::from_millis(500);

type Sample = [Option<f64>; 5];

/// A device that is being watched. The tool may hang where the device does, so nobody waits for it.
pub(super) struct Watch {
    is_over: Arc<AtomicBool>,
    samples: Receiver<Sample>,
}

impl Watch {
    pub(super) fn begin() -> Self {
        let is_over = Arc::new(AtomicBool::new(false));
        let (sender, samples) = mpsc::channel();
        let over = Arc::clone(&is_over);
        std::thread::spawn(move || {
            while !over.load(Ordering::Relaxed) {
                let Some(sample) = query(QUERY).as_deref().and_then(sample) else { return };
                if sender.send(sample).is_err() {
                    return;
                }
                std::thread::sleep(INTERVAL);
            }
        });
        Self { is_over, samples }
    }

    pub(super) fn end(self) -> Option<DeviceUse> {
        self.is_over.store(true, Ordering::Relaxed);
        of_samples(&self.samples.try_iter().collect::<Vec<_>>())
    }
}

/// Name, driver, memory and the greatest clocks of the devices, a line each; `None` without the tool.
pub(super) fn describe() -> Option<String> {
    query(
        "name,driver_version,vbios_version,memory.total,clocks.max.sm,clocks.max.mem,pcie.link.gen.max",
    )
}

fn query(fields: &str) -> Option<String> {
    let known = ["/usr/bin/nvidia-smi", "/usr/local/nvidia/bin/nvidia-smi"];
    let found = known.into_iter().find(|path| Path::new(path).exists());
    let output = Command::new(found.unwrap_or("nvidia-smi"))
        .arg(format!("--query-gpu={fields}"))
        .arg("--format=csv,noheader,nounits")
        .output()
        .ok()?;
    output.status.success().then(|| String::from_utf8_lossy(&output.stdout).trim().to_owned())
}

/// The first device's numbers; of what the tool does not know it prints something else.
fn sample(text: &str) -> Option<Sample> {
    let numbers = text.lines().next()?.split(',').map(|field| field.trim().parse().ok());
    numbers.collect::<Vec<Option<f64>>>().try_into().ok()
}

fn of_samples(samples: &[Sample]) -> Option<DeviceUse> {
    let span = |field: usize| {
        let numbers = samples.iter().filter_map(|sample| sample[field]);
        numbers.fold(None, |span: Option<Span>, number| {
            let span = span.unwrap_or(Span { least: number, most: number });
            Some(Span { least: span.least.min(number), most: span.most.max(number) })
        })
    };
    (!samples.is_empty()).then(|| DeviceUse {
        samples: samples.len(),
        memory_mib: span(0),
        clock_mhz: span(1),
        memory_clock_mhz: span(2),
        celsius: span(3),
        watts: span(4),
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn samples_are_numbers_or_unknown() {
        let first = sample("1024, 345, 3201, 31, [N/A]\n").expect("five");
        let second = sample("2048, 1980, 3201, 40, [N/A]").expect("five");
        assert_eq!(sample("an error"), None);
        let device = of_samples(&[first, second]).expect("of two");
        assert_eq!((device.samples, device.watts), (2, None));
        assert_eq!(device.memory_mib.map(|span| span.most), Some(2048.0));
        assert_eq!(device.clock_mhz, Some(Span { least: 345.0, most: 1980.0 }));
        assert_eq!(of_samples(&[]), None);
    }
}
