//! What stills and films share: adapter, size, views and style.

use crate::audience::Audience;
use crate::draw_job::PictureOptions;
use crate::error::Error;
use rendering::{AdapterChoice, Gpu, Renderer, Style, ViewLayout, Viewpoint};
use scene::composed;
use std::collections::BTreeSet;
use vocabulary::FleetInfo;

/// Everything that draws.
pub struct RenderSetup {
    /// The adapter.
    pub gpu: Gpu,
    /// Draws on it.
    pub renderer: Renderer,
    /// Views.
    pub layout: ViewLayout,
    /// What is shown.
    pub style: Style,
    /// Width and height, pixels.
    pub size: [u32; 2],
    /// Characters of names that no font has; they are reported already.
    lacks: BTreeSet<char>,
}

impl RenderSetup {
    /// Checks the words first and opens the adapter last, since that takes longest. `view` and `size` are those where
    /// `options` name none.
    ///
    /// # Errors
    /// A view, an element or a size that there is not, or no such adapter.
    pub fn open(
        adapter: &str,
        options: &PictureOptions,
        fleet: &FleetInfo,
        view: &str,
        size: [u32; 2],
        audience: &dyn Audience,
    ) -> Result<Self, Error> {
        let gpu = || Ok(Gpu::open(&AdapterChoice::from(adapter))?);
        Self::on(gpu, options, fleet, view, size, audience)
    }

    /// As [`RenderSetup::open`], on an adapter that is opened once the words are checked.
    ///
    /// # Errors
    /// As [`RenderSetup::open`].
    pub fn on(
        gpu: impl FnOnce() -> Result<Gpu, Error>,
        options: &PictureOptions,
        fleet: &FleetInfo,
        view: &str,
        size: [u32; 2],
        audience: &dyn Audience,
    ) -> Result<Self, Error> {
        let names: Vec<String> = fleet.robots.iter().map(|m| m.name.clone()).collect();
        let layout = ViewLayout::parse(&composed(options.view.as_deref().unwrap_or(view)), &names)?;
        let size = options.size.unwrap_or(size);
        let mut style = Style::without(&options.without)?;
        style.detections = options.overlay || options.inset_camera.is_some();
        let cameras = layout.views.iter().any(|view| matches!(view, Viewpoint::Camera(_)));
        if options.overlay && !cameras && options.inset_camera.is_none() {
            audience.about(
                "overlay",
                "shows in views through cameras only: add the view camera:ROBOT, or inset the camera of a robot",
            );
        } else if style.detections && !fleet.has_sensors {
            let (option, what) = match options.inset_camera {
                Some(_) => ("inset_camera", "shows the picture of that robot without detections"),
                None => ("overlay", "has no detections to show"),
            };
            let why = "no follower has a sensor in this scene; try sensing.kind=camera";
            audience.about(option, &format!("{what}: {why}"));
        }
        if let Some(robot) = &options.inset_camera {
            // The same words and the same mistakes as in a view.
            let view = ViewLayout::parse(&composed(&format!("camera:{robot}")), &names)?;
            style.picture_in_picture = view.views.iter().find_map(|view| match view {
                Viewpoint::Camera(index) => Some(*index),
                _ => None,
            });
        }
        style.scale = options.scale.unwrap_or_else(|| Style::scale_for(size[0], size[1]));
        let gpu = gpu()?;
        let renderer = Renderer::new(&gpu, fleet, size[0], size[1], options.samples)?;
        let named = names.iter().chain([&fleet.title, &fleet.caption]).map(String::as_str);
        let lacks = renderer.unwritable(named);
        tell_lacking(&lacks, audience);
        Ok(Self { gpu, renderer, layout, style, size, lacks })
    }

    /// Says which more characters no font has, of texts besides the names.
    pub fn check_texts<'a>(&self, texts: impl IntoIterator<Item = &'a str>, audience: &dyn Audience) {
        tell_lacking(&(&self.renderer.unwritable(texts) - &self.lacks), audience);
    }
}

/// Says which characters will be boxes in a picture, if any will.
fn tell_lacking(lacks: &BTreeSet<char>, audience: &dyn Audience) {
    const MOST: usize = 12;
    if lacks.is_empty() {
        return;
    }
    let some: String = lacks.iter().take(MOST).collect();
    let more = if lacks.len() > MOST { format!(" and {} more", lacks.len() - MOST) } else { String::new() };
    audience.note(&format!(
        "no font of this machine has {some}{more}: boxes are drawn in their place; a font with them helps, such as those of \
         the package fonts-noto or fonts-noto-cjk (Debian, Ubuntu)"
    ));
}
