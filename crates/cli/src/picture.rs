//! What stills and films share: adapter, size, views and style.

use crate::args::PictureArgs;
use crate::failure::Failure;
use crate::print::note;
use rendering::{AdapterChoice, Gpu, Layout, Renderer, Style, View};
use vocabulary::Cast;

/// Everything that draws.
pub(crate) struct Studio {
    pub(crate) gpu: Gpu,
    pub(crate) renderer: Renderer,
    pub(crate) layout: Layout,
    pub(crate) style: Style,
    pub(crate) size: [u32; 2],
}

impl Studio {
    /// Checks the words first and opens the adapter last, since that takes longest.
    pub(crate) fn open(
        (adapter, args): (&str, &PictureArgs),
        cast: &Cast,
        view: &str,
        size: [u32; 2],
    ) -> Result<Self, Failure> {
        let names: Vec<String> = cast.members.iter().map(|m| m.name.clone()).collect();
        let layout = Layout::parse(args.view.as_deref().unwrap_or(view), &names)?;
        let size = args.size.unwrap_or(size);
        let mut style = Style::without(&args.without)?;
        style.detections = args.overlay || args.inset_camera.is_some();
        let cameras = layout.views.iter().any(|view| matches!(view, View::Camera(_)));
        if args.overlay && !cameras && args.inset_camera.is_none() {
            note(
                "--overlay shows in views through cameras only: add --view camera:ROBOT or --inset-camera ROBOT",
            );
        } else if style.detections && !cast.looks {
            note("nobody looks in this scene, so there is nothing to overlay: try --set sensing.kind=camera");
        }
        if let Some(robot) = &args.inset_camera {
            // The same words and the same mistakes as in a view.
            let view = Layout::parse(&format!("camera:{robot}"), &names)?;
            style.picture_in_picture = view.views.iter().find_map(|view| match view {
                View::Camera(index) => Some(*index),
                _ => None,
            });
        }
        // Text that suits 720 lines suits no poster: it grows with the picture, and never below its size there. What is
        // higher than wide is looked at on a phone.
        let [width, height] = size.map(f64::from);
        let grown = if height > width { width / 640.0 } else { height / 720.0 };
        style.scale = args.scale.unwrap_or_else(|| grown.max(1.0));
        let gpu = Gpu::open(&AdapterChoice::from(adapter))?;
        let renderer = Renderer::new(&gpu, cast, size[0], size[1], args.samples)?;
        Ok(Self { gpu, renderer, layout, style, size })
    }
}
