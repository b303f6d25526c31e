//! Step records to pictures.
//!
//! ```no_run
//! use rendering::{AdapterChoice, Gpu, Layout, Renderer, Style, Trail, View};
//! # fn shown(fleet: &vocabulary::FleetInfo, records: &[vocabulary::StepRecord]) -> Result<(), rendering::Error> {
//! let gpu = Gpu::open(&AdapterChoice::Auto)?;
//! let mut renderer = Renderer::new(&gpu, fleet, 1280, 720, 4)?;
//! let mut trail = Trail::new(fleet);
//! for record in records {
//!     trail.push(record);
//! }
//! if let Some(last) = records.last() {
//!     let picture = renderer.draw(&trail, last, &Layout::single(View::Snake), &Style::default())?;
//!     println!("{} bytes by {}", picture.rgba.len(), gpu.description());
//! }
//! # Ok(())
//! # }
//! ```
//!
//! A [`Trail`] remembers the past, a [`Renderer`] draws a moment on top of it from the views of a [`ViewLayout`].
//! The world is f64; positions are narrowed to f32 relative to an origin near the robots. Pictures are sRGB.
//! The same records give the same picture, byte for byte, on the same adapter.

mod atlas;
mod camera;
mod carried;
mod chalk;
mod compose;
mod composition;
mod crowd;
mod detections;
mod drape;
mod encode;
mod error;
mod eyes;
mod flash;
mod floor;
mod glide;
mod gpu;
mod inset;
mod labels;
mod letters;
mod model;
mod paint;
mod palette;
mod passes;
mod pick;
mod plan;
mod props;
mod renderer;
mod room;
mod shade;
mod show;
mod sightline;
mod sketch;
mod snake;
mod steady;
mod style;
mod target;
mod thin;
mod trail;
mod view;
mod world;

pub use composition::Composition;
pub use error::Error;
pub use eyes::GpuCameraRenderer;
pub use gpu::{AdapterChoice, AdapterInfo, Gpu, adapters};
pub use letters::FONT;
pub use palette::robot_colours;
pub use pick::Picked;
pub use renderer::Renderer;
pub use show::{Card, CurvePanel, Overlays, PanelCurve, ReservedSpace, Subtitle};
pub use sightline::Sightline;
pub use sketch::{AnnotationArrow, AnnotationStroke, Annotations, Ghost, Ring, ShadedArea, StrokePoint};
pub use style::Style;
pub use trail::{Trail, set_points};
pub use view::{FreeCamera, Tile, ViewLayout, Viewpoint};
