//! Step records to pictures.
//!
//! ```no_run
//! use rendering::{AdapterChoice, Gpu, PictureSpec, ViewLayout, Renderer, Style, Trail, Viewpoint};
//! # fn shown(fleet: &vocabulary::FleetInfo, records: &[vocabulary::StepRecord]) -> Result<(), rendering::Error> {
//! let gpu = Gpu::open(&AdapterChoice::Auto)?;
//! let mut renderer = Renderer::new(&gpu, fleet, 1280, 720, 4)?;
//! let mut trail = Trail::new(fleet);
//! for record in records {
//!     trail.push(record);
//! }
//! if let Some(last) = records.last() {
//!     let picture = renderer.draw(PictureSpec::new(&trail, last, &ViewLayout::single(Viewpoint::Snake), &Style::default()))?;
//!     println!("{} bytes by {}", picture.rgba.len(), gpu.description());
//! }
//! # Ok(())
//! # }
//! ```
//!
//! A [`Trail`] remembers the past, a [`Renderer`] draws a moment on top of it from the views of a [`ViewLayout`].
//! The world is f64; positions are narrowed to f32 relative to an origin near the robots. Pictures are sRGB.
//! The same records give the same picture, byte for byte, on the same adapter.

mod annotation;
mod camera;
mod compose;
mod composition;
mod error;
mod fleet_model;
mod gpu;
mod ground;
mod palette;
mod picture_context;
mod picture_plan;
mod picture_spec;
mod renderer;
mod style;

pub use annotation::annotations::{
    AnnotationArrow, AnnotationStroke, Annotations, Ghost, Ring, ShadedArea, StrokePoint,
};
pub use annotation::overlays::{Card, CurvePanel, Overlays, PanelCurve, ReservedSpace, Subtitle};
pub use annotation::text_shaper::FONT;
pub use camera::pick::Picked;
pub use camera::sightline::Sightline;
pub use camera::viewpoint::{FreeCamera, Tile, ViewLayout, Viewpoint};
pub use composition::Composition;
pub use error::Error;
#[cfg(not(target_family = "wasm"))]
pub use gpu::adapters::{AdapterChoice, adapters};
pub use gpu::camera_renderer::GpuCameraRenderer;
pub use gpu::passes::texture::{TextureBinding, TexturePass};
pub use gpu::{AdapterInfo, Gpu, draws_on_processor};
pub use ground::trail::{Trail, free_places, set_points};
pub use palette::{narrowing_colour, robot_colours};
pub use picture_spec::PictureSpec;
pub use renderer::Renderer;
pub use style::Style;
