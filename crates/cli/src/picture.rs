//! What stills and films share: adapter, size, views and style.

use crate::args::{PictureArgs, SceneArgs};
use crate::failure::Failure;
use crate::load::stem;
use crate::print::note;
use rendering::{AdapterChoice, Gpu, Renderer, Style, ViewLayout, Viewpoint};
use scene::composed;
use std::collections::BTreeSet;
use studies::SceneRun;
use vocabulary::FleetInfo;

/// A run to draw, of a scene or recorded, and how.
pub(crate) struct DrawJob<'a> {
    pub(crate) picture: &'a PictureArgs,
    pub(crate) adapter: &'a str,
    pub(crate) quiet: bool,
    pub(crate) json: bool,
    /// What files are called by.
    pub(crate) name: String,
    pub(crate) fleet: FleetInfo,
    /// s.
    pub(crate) duration: f64,
    pub(crate) settings: scene::Film,
    /// The view where nothing names one.
    pub(crate) view: String,
}

impl<'a> DrawJob<'a> {
    /// That of a scene.
    pub(crate) fn of(args: &'a SceneArgs, picture: &'a PictureArgs, run: &SceneRun) -> Self {
        Self {
            picture,
            adapter: &args.adapter.name,
            quiet: args.quiet,
            json: args.json,
            name: stem(&args.scene),
            fleet: run.simulation.fleet().clone(),
            duration: run.scene.time.duration,
            settings: run.scene.film.clone(),
            view: run.scene.views.default.clone(),
        }
    }
}

/// Everything that draws.
pub(crate) struct RenderSetup {
    pub(crate) gpu: Gpu,
    pub(crate) renderer: Renderer,
    pub(crate) layout: ViewLayout,
    pub(crate) style: Style,
    pub(crate) size: [u32; 2],
    /// Characters of names that no font has; they are reported already.
    lacks: BTreeSet<char>,
}

impl RenderSetup {
    /// Checks the words first and opens the adapter last, since that takes longest.
    pub(crate) fn open(
        adapter: &str,
        args: &PictureArgs,
        fleet: &FleetInfo,
        view: &str,
        size: [u32; 2],
    ) -> Result<Self, Failure> {
        let names: Vec<String> = fleet.robots.iter().map(|m| m.name.clone()).collect();
        let layout = ViewLayout::parse(&composed(args.view.as_deref().unwrap_or(view)), &names)?;
        let size = args.size.unwrap_or(size);
        let mut style = Style::without(&args.without)?;
        style.detections = args.overlay || args.inset_camera.is_some();
        let cameras = layout.views.iter().any(|view| matches!(view, Viewpoint::Camera(_)));
        if args.overlay && !cameras && args.inset_camera.is_none() {
            note(
                "--overlay shows in views through cameras only: add --view camera:ROBOT or --inset-camera ROBOT",
            );
        } else if style.detections && !fleet.has_sensors {
            let (flag, what) = match args.inset_camera {
                Some(_) => ("--inset-camera", "shows the picture of that robot without detections"),
                None => ("--overlay", "has no detections to show"),
            };
            note(&format!(
                "{flag} {what}: no follower has a sensor in this scene; try --set sensing.kind=camera"
            ));
        }
        if let Some(robot) = &args.inset_camera {
            // The same words and the same mistakes as in a view.
            let view = ViewLayout::parse(&composed(&format!("camera:{robot}")), &names)?;
            style.picture_in_picture = view.views.iter().find_map(|view| match view {
                Viewpoint::Camera(index) => Some(*index),
                _ => None,
            });
        }
        style.scale = args.scale.unwrap_or_else(|| Style::scale_for(size[0], size[1]));
        let gpu = Gpu::open(&AdapterChoice::from(adapter))?;
        let renderer = Renderer::new(&gpu, fleet, size[0], size[1], args.samples)?;
        let named = names.iter().chain([&fleet.title, &fleet.caption]).map(String::as_str);
        let lacks = renderer.unwritable(named);
        tell_lacking(&lacks);
        Ok(Self { gpu, renderer, layout, style, size, lacks })
    }

    /// Says which more characters no font has, of texts besides the names.
    pub(crate) fn check_texts<'a>(&self, texts: impl IntoIterator<Item = &'a str>) {
        tell_lacking(&(&self.renderer.unwritable(texts) - &self.lacks));
    }
}

/// Says which characters will be boxes in a picture, if any will.
fn tell_lacking(lacks: &BTreeSet<char>) {
    const MOST: usize = 12;
    if lacks.is_empty() {
        return;
    }
    let some: String = lacks.iter().take(MOST).collect();
    let more = if lacks.len() > MOST { format!(" and {} more", lacks.len() - MOST) } else { String::new() };
    note(&format!(
        "no font of this machine has {some}{more}: boxes are drawn in their place; a font with them helps, such as those of \
         the package fonts-noto or fonts-noto-cjk (Debian, Ubuntu)"
    ));
}
