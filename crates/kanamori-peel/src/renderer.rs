//! The method behind [`IsoRenderer`].

use std::time::{Duration, Instant};

use glam::Vec3;
use metaball_core::Scene;
use metaball_core::gpu::{
    BuildReport, Frame, FrameStatus, Gpu, IsoRenderer, RenderError, Specialization,
};

use crate::balls::{Balls, MOST_BALLS};
use crate::layer_limit::LayerLimit;
use crate::layers::Layers;
use crate::options::{Options, Registration};
use crate::passes::Passes;
use crate::pipelines::Pipelines;
use crate::registration::register;
use crate::tiles::{ALL_TILES, Grid, Tile, TileBuffers};

/// Registrations for each ball that a scene's buffers begin with.
const FIRST_REGISTRATIONS: u32 = 4;

/// Draws primary rays by depth peeling.
pub struct Renderer {
    name: &'static str,
    options: Options,
    counting: bool,
    layer_limit: LayerLimit,
    pipelines: Option<Pipelines>,
    balls: Option<Balls>,
    /// For the host's registration.
    supports: Vec<(Vec3, f32)>,
    tiles: Option<TileBuffers>,
    layers: Option<Layers>,
}

impl Renderer {
    /// A renderer without a scene. `counting` makes shaders that count their work, which costs
    /// time.
    pub fn new(name: &'static str, options: Options, counting: bool) -> Self {
        Self {
            name,
            options,
            counting,
            layer_limit: LayerLimit::new(),
            pipelines: None,
            balls: None,
            supports: Vec::new(),
            tiles: None,
            layers: None,
        }
    }

    /// Registrations that the tiles' buffers hold.
    #[cfg(test)]
    pub(crate) fn registration_capacity(&self) -> Option<u32> {
        self.tiles.as_ref().map(|tiles| tiles.capacity)
    }

    /// Layers that the last frame could have.
    #[cfg(test)]
    pub(crate) fn layer_limit(&self) -> u32 {
        self.layer_limit.layers()
    }

    /// Rectangles of the last frame.
    #[cfg(test)]
    pub(crate) fn placed(&self) -> Option<&wgpu::Buffer> {
        self.balls.as_ref().map(|balls| &balls.placed)
    }
}

impl IsoRenderer for Renderer {
    fn name(&self) -> &'static str {
        self.name
    }

    fn build(&mut self, gpu: &Gpu, scene: &Scene) -> Result<BuildReport, RenderError> {
        self.balls = None;
        self.options.check(gpu, self.name)?;
        RenderError::check_positive(self.name, scene)?;
        if scene.len() > MOST_BALLS {
            let found = scene.len();
            let reason = format!("needed at most {MOST_BALLS} balls, found {found}");
            return Err(RenderError::Unsupported { method: self.name, reason });
        }
        let start = Instant::now();
        let specialization = Specialization::of(scene, self.counting);
        let pipelines = match self.pipelines.take() {
            Some(pipelines) if pipelines.specialization == specialization => pipelines,
            _ => Pipelines::new(gpu, self.name, specialization, &self.options)?,
        };
        let compilation = start.elapsed();

        let balls = Balls::new(gpu, scene, &pipelines.layouts)?;
        let capacity = FIRST_REGISTRATIONS.saturating_mul(balls.count.max(1));
        let tiles =
            TileBuffers::new(gpu, &balls, &pipelines.layouts, self.options.registration, capacity)?;
        let report = BuildReport {
            // The method has no structure.
            structure: Duration::ZERO,
            pipelines: compilation,
            upload_bytes: balls.scene.bytes() + balls.own_upload_bytes(),
            device_bytes: balls.scene.bytes() + balls.own_bytes() + tiles.bytes(),
            facts: Vec::new(),
        };
        self.supports = match self.options.registration {
            Registration::Host => scene.balls().map(|ball| (ball.center, ball.radius)).collect(),
            Registration::Adapter => Vec::new(),
        };
        self.layers = None;
        self.tiles = Some(tiles);
        self.pipelines = Some(pipelines);
        self.balls = Some(balls);
        Ok(report)
    }

    fn encode(&mut self, frame: &mut Frame<'_>) -> Result<(), RenderError> {
        let (Some(pipelines), Some(balls), Some(tiles)) =
            (&self.pipelines, &self.balls, &mut self.tiles)
        else {
            return Err(RenderError::NotBuilt { method: self.name });
        };
        let (gpu, view) = (frame.gpu(), frame.view());
        let size = (view.width(), view.height());
        let layers = match self.layers.take() {
            Some(layers) if layers.size == size => layers,
            _ => Layers::new(gpu, size, self.options.targets(), &pipelines.layouts)?,
        };
        let grid = Grid::new(self.options.tiles, [view.width(), view.height()]);
        let mut most_balls = vec![balls.count; ALL_TILES as usize];
        if self.options.registration == Registration::Host {
            let (of_tiles, registered) =
                frame.cpu("register", || register(&self.supports, view, &grid));
            if registered.len() > tiles.capacity as usize {
                let capacity = registered.len().next_power_of_two().min(u32::MAX as usize) as u32;
                *tiles =
                    TileBuffers::new(gpu, balls, &pipelines.layouts, Registration::Host, capacity)?;
            }
            tiles.fill(gpu, &of_tiles, &registered)?;
            most_balls = of_tiles.iter().map(|tile| tile.balls).collect();
        }
        let peeled = grid.peeled(&most_balls);
        let most_layers = peeled.iter().map(|tile| tile.most_layers).max().unwrap_or(0);

        let passes = Passes { pipelines, balls, tiles, layers: &layers, options: &self.options };
        balls.begin(gpu, view, frame.encoder())?;
        passes.arrange(frame);
        if self.options.registration == Registration::Adapter {
            passes.register(frame);
        }
        for layer in 0..self.layer_limit.next(gpu, most_layers)? {
            passes.turn(frame);
            passes.peel(frame, layer, &peeled);
            passes.test(frame, layer);
        }
        passes.account(frame);
        self.layer_limit.note(gpu, frame.encoder(), tiles)?;
        self.layers = Some(layers);
        Ok(())
    }

    fn frame_bytes(&self) -> u64 {
        self.layers.as_ref().map_or(0, Layers::bytes)
    }

    /// `balls in view`, and `balls drawn` of them; `culled`, the share of the former that is not
    /// among the latter (section 5.2); `registrations`, in which a ball counts once for each of its
    /// tiles (section 5.3); and `layers`, of the tile that took most.
    fn frame_facts(&self, gpu: &Gpu) -> Result<Vec<(&'static str, f64)>, RenderError> {
        let (Some(balls), Some(tiles)) = (&self.balls, &self.tiles) else {
            return Err(RenderError::NotBuilt { method: self.name });
        };
        let arranged = balls.arranged(gpu)?;
        let tiles: Vec<Tile> = gpu.read(tiles.tiles())?;
        let [in_view, drawn] = [arranged.in_view, arranged.drawn].map(f64::from);
        Ok(vec![
            ("balls in view", in_view),
            ("balls drawn", drawn),
            ("culled", 1.0 - drawn / in_view.max(1.0)),
            ("registrations", tiles.iter().map(|tile| f64::from(tile.balls)).sum()),
            ("layers", tiles.iter().map(|tile| f64::from(tile.layers)).fold(0.0, f64::max)),
        ])
    }

    /// Larger buffers where the tiles have more balls than they hold, or else twice as many layers.
    fn grow(&mut self, gpu: &Gpu, status: &FrameStatus) -> Result<bool, RenderError> {
        let (Some(pipelines), Some(balls), Some(tiles)) =
            (&self.pipelines, &self.balls, &mut self.tiles)
        else {
            return Err(RenderError::NotBuilt { method: self.name });
        };
        let [registrations, ..] = status.needed;
        if registrations > tiles.capacity {
            let capacity = registrations.checked_next_power_of_two().unwrap_or(registrations);
            *tiles = TileBuffers::new(
                gpu,
                balls,
                &pipelines.layouts,
                self.options.registration,
                capacity,
            )?;
            self.layer_limit.keep();
            return Ok(true);
        }
        Ok(self.layer_limit.grow())
    }
}
