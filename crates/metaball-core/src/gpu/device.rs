//! The device, and buffers on it.

use std::io::Write;
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::{Arc, Mutex, PoisonError};

use bytemuck::Pod;

use super::adapter::{AdapterChoice, AdapterReport, GpuError, choose};
use super::error::RenderError;
use super::shader_checks::ShaderChecks;

/// A device with its queue. Made once; everything else borrows it.
///
/// An error of wgpu does not panic: the first is kept, and the next function of this module that can
/// fail returns it as a [`RenderError`]. With several threads on one device, that may be another
/// thread's.
#[derive(Debug)]
pub struct Gpu {
    /// The device.
    pub device: wgpu::Device,
    /// Its queue.
    pub queue: wgpu::Queue,
    report: AdapterReport,
    raised: Arc<Mutex<Option<RenderError>>>,
    code: AtomicU64,
}

impl Gpu {
    /// Opens an adapter, with timestamps if it has them and no other feature, and with its own limits
    /// on the size of a scene and of a picture, on the storage buffers of a shader, and on the targets
    /// of a pass.
    ///
    /// # Errors
    /// When there is no such adapter; the text says what to install. When `METABALL_SHADER_CHECKS` is
    /// neither `on` nor `off`, by which [`ShaderChecks`] are other than the adapter's.
    pub fn new(choice: &AdapterChoice) -> Result<Self, GpuError> {
        let checks = ShaderChecks::of_environment()?;
        let adapter = choose(choice)?;
        let info = adapter.get_info();
        let features = adapter.features() & wgpu::Features::TIMESTAMP_QUERY;
        let own = adapter.limits();
        let limits = wgpu::Limits {
            max_buffer_size: own.max_buffer_size,
            max_storage_buffer_binding_size: own.max_storage_buffer_binding_size,
            max_storage_buffers_per_shader_stage: own.max_storage_buffers_per_shader_stage,
            max_texture_dimension_2d: own.max_texture_dimension_2d,
            max_color_attachments: own.max_color_attachments,
            max_color_attachment_bytes_per_sample: own.max_color_attachment_bytes_per_sample,
            ..wgpu::Limits::default()
        };
        let descriptor = wgpu::DeviceDescriptor {
            label: Some("metaballs"),
            required_features: features,
            required_limits: limits,
            ..wgpu::DeviceDescriptor::default()
        };
        let (device, queue) =
            pollster::block_on(adapter.request_device(&descriptor)).map_err(|error| {
                GpuError::NoDevice { adapter: info.name.clone(), reason: error.to_string() }
            })?;
        let gpu = Self::of_device(&adapter, device, queue);
        Ok(match checks {
            Some(checks) => gpu.with_shader_checks(checks),
            None => gpu,
        })
    }

    /// The same, of whose shaders those made from now on check indices and loops, or do not.
    #[must_use]
    pub fn with_shader_checks(mut self, checks: ShaderChecks) -> Self {
        self.report.shader_checks = checks;
        self
    }

    /// As [`Gpu::new`]; `None` on a machine that has no adapter at all, unless one is asked for by name.
    ///
    /// # Errors
    /// When there are adapters and none is the one chosen, or it does not open.
    pub fn find(choice: &AdapterChoice) -> Result<Option<Self>, GpuError> {
        match Self::new(choice) {
            Ok(gpu) => Ok(Some(gpu)),
            Err(GpuError::NoAdapter { choice, found })
                if found.is_empty() && !matches!(choice, AdapterChoice::Named(_)) =>
            {
                Ok(None)
            }
            Err(error) => Err(error),
        }
    }

    /// Takes a device that the caller has opened, with the adapter that it was opened on. Scenes and
    /// pictures are bounded by the device's limits; passes are timed where it has timestamps. The
    /// device's handlers for uncaptured errors and for its loss are replaced: such errors are kept for
    /// [`Gpu::checked`].
    pub fn of_device(adapter: &wgpu::Adapter, device: wgpu::Device, queue: wgpu::Queue) -> Self {
        let timestamps = device.features().contains(wgpu::Features::TIMESTAMP_QUERY);
        let report = AdapterReport::new(&adapter.get_info(), &device.limits(), timestamps);
        let raised = Arc::default();
        listen(&device, &raised);
        Self { device, queue, report, raised, code: AtomicU64::new(0) }
    }

    /// A device for a test. Without an adapter it returns `None` and prints the test's name as ignored;
    /// where the environment sets `REQUIRE_GPU` it panics instead.
    ///
    /// # Panics
    /// When there is no device and `REQUIRE_GPU` is set.
    pub fn for_test() -> Option<Self> {
        match Self::new(&AdapterChoice::Environment) {
            Ok(gpu) => Some(gpu),
            Err(error) if std::env::var_os("REQUIRE_GPU").is_some() => {
                panic!("REQUIRE_GPU is set: {error}")
            }
            Err(_) => {
                // Past the capture of test output: a test that did not run must not look passed.
                let thread = std::thread::current();
                let test = thread.name().unwrap_or("a test");
                let _ = writeln!(std::io::stderr(), "{test}: ignored: no adapter");
                None
            }
        }
    }

    /// The adapter, its driver and its limits.
    pub fn report(&self) -> &AdapterReport {
        &self.report
    }

    /// Size of all shaders made on this device so far, in the unit of
    /// [`code_size`](metaball_shaders::code_size).
    pub fn code(&self) -> u64 {
        self.code.load(Ordering::Relaxed)
    }

    pub(super) fn count_code(&self, size: u64) {
        self.code.fetch_add(size, Ordering::Relaxed);
    }

    /// Runs `work`, which calls wgpu, and returns its result.
    ///
    /// # Errors
    /// The first error that wgpu raised since errors were last checked.
    pub fn checked<T>(&self, work: impl FnOnce() -> T) -> Result<T, RenderError> {
        let made = work();
        match self.raised.lock().unwrap_or_else(PoisonError::into_inner).take() {
            Some(raised) => Err(raised),
            None => Ok(made),
        }
    }

    /// A buffer of zeros that can be bound as storage, copied from and copied to, and used as
    /// `usages` adds. Its size is `bytes` rounded up to a multiple of four, and at least four: a
    /// binding cannot be empty. `what` names it in errors and in wgpu's tools.
    ///
    /// # Errors
    /// When the adapter cannot bind so many bytes, or has too little memory.
    pub fn storage(
        &self,
        what: &'static str,
        bytes: u64,
        usages: wgpu::BufferUsages,
    ) -> Result<wgpu::Buffer, RenderError> {
        let limit_bytes = self.report.max_binding_bytes.min(self.report.max_buffer_bytes);
        if bytes > limit_bytes {
            return Err(RenderError::TooLarge { what, needed_bytes: bytes, limit_bytes });
        }
        self.checked(|| {
            self.device.create_buffer(&wgpu::BufferDescriptor {
                label: Some(what),
                size: bytes.max(4).next_multiple_of(4),
                usage: wgpu::BufferUsages::STORAGE
                    | wgpu::BufferUsages::COPY_SRC
                    | wgpu::BufferUsages::COPY_DST
                    | usages,
                mapped_at_creation: false,
            })
        })
    }

    /// A storage buffer that holds the elements; the size of one when there are none.
    ///
    /// # Errors
    /// As [`Gpu::storage`].
    pub fn upload<T: Pod>(
        &self,
        what: &'static str,
        elements: &[T],
        usages: wgpu::BufferUsages,
    ) -> Result<wgpu::Buffer, RenderError> {
        let bytes = size_of_val(elements).max(size_of::<T>()) as u64;
        let buffer = self.storage(what, bytes, usages)?;
        self.checked(|| self.queue.write_buffer(&buffer, 0, bytemuck::cast_slice(elements)))?;
        Ok(buffer)
    }

    /// The contents of a buffer, after all that was submitted. For results, not inside frames: it
    /// waits, and holds as many bytes again meanwhile.
    ///
    /// # Errors
    /// When the device fails.
    pub fn read<T: Pod>(&self, buffer: &wgpu::Buffer) -> Result<Vec<T>, RenderError> {
        let staging = self.checked(|| {
            let staging = self.device.create_buffer(&wgpu::BufferDescriptor {
                label: Some("read back"),
                size: buffer.size(),
                usage: wgpu::BufferUsages::COPY_DST | wgpu::BufferUsages::MAP_READ,
                mapped_at_creation: false,
            });
            let mut encoder = self.device.create_command_encoder(&Default::default());
            encoder.copy_buffer_to_buffer(buffer, 0, &staging, 0, buffer.size());
            self.queue.submit([encoder.finish()]);
            staging
        })?;
        self.read_mapped(&staging, |bytes| bytemuck::pod_collect_to_vec(bytes))
    }

    /// Maps a buffer, passes its bytes to `read`, and unmaps it.
    ///
    /// # Errors
    /// When the buffer cannot be mapped, or the device fails.
    pub fn read_mapped<T>(
        &self,
        buffer: &wgpu::Buffer,
        read: impl FnOnce(&[u8]) -> T,
    ) -> Result<T, RenderError> {
        let lost = |text: String| RenderError::DeviceLost { text };
        let (sender, receiver) = std::sync::mpsc::channel();
        self.checked(|| {
            buffer.slice(..).map_async(wgpu::MapMode::Read, move |outcome| {
                // The receiver outlives the wait below: nothing is lost.
                let _ = sender.send(outcome);
            });
        })?;
        self.wait()?;
        receiver
            .recv()
            .map_err(|error| lost(error.to_string()))?
            .map_err(|error| lost(error.to_string()))?;
        let contents = {
            let view = buffer.get_mapped_range(..).map_err(|error| lost(error.to_string()))?;
            read(&view)
        };
        buffer.unmap();
        Ok(contents)
    }

    /// Waits for the fence of everything submitted.
    pub(super) fn wait(&self) -> Result<(), RenderError> {
        let outcome = self.checked(|| self.device.poll(wgpu::PollType::wait_indefinitely()))?;
        outcome.map(|_| ()).map_err(|error| RenderError::DeviceLost { text: error.to_string() })
    }
}

/// Keeps the first error, in place of wgpu's panic.
fn listen(device: &wgpu::Device, raised: &Arc<Mutex<Option<RenderError>>>) {
    let keep = |slot: &Mutex<Option<RenderError>>, error: RenderError| {
        log::error!("{error}");
        slot.lock().unwrap_or_else(PoisonError::into_inner).get_or_insert(error);
    };
    let slot = Arc::clone(raised);
    device.on_uncaptured_error(Arc::new(move |error| {
        let text = error.to_string();
        keep(
            &slot,
            match error {
                wgpu::Error::OutOfMemory { .. } => RenderError::OutOfMemory { text },
                wgpu::Error::Validation { .. } => RenderError::Refused { text },
                wgpu::Error::Internal { .. } => RenderError::DeviceLost { text },
            },
        );
    }));
    let slot = Arc::clone(raised);
    device.set_device_lost_callback(move |reason, text| {
        // Dropping a device is no loss.
        if reason != wgpu::DeviceLostReason::Destroyed {
            keep(&slot, RenderError::DeviceLost { text });
        }
    });
}
