//! The 3D view in its tile: it is rendered when its content has changed.

mod density;
mod pointer;

use self::density::Density;
use self::pointer::Drag;
use crate::action::Action;
use crate::app_state::{AppState, Tool};
use crate::numbers::fixed;
use crate::view::annotations::{PointerState, annotations};
use crate::view::camera::CameraControl;
use eframe::egui::{self, Color32, PaintCallbackInfo, Pos2, Rect, Sense, Ui, Vec2};
use eframe::egui_wgpu::{Callback, CallbackResources, CallbackTrait, RenderState};
use rendering::{
    Error, Gpu, PictureSpec, Renderer, Sightline, Style, TextureBinding, TexturePass, Trail, ViewLayout,
    Viewpoint,
};
use std::sync::Arc;
use vocabulary::{FleetInfo, StepRecord};

/// Format of pictures.
const FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Rgba8Unorm;
/// Minimum and maximum size of the view, pixels.
const SIZES: [u32; 2] = [16, 8192];

/// The 3D view.
pub struct Viewport {
    /// Lays pictures into the window.
    painter: Arc<TexturePass>,
    /// The same for pictures of fewer pixels.
    stretcher: Arc<TexturePass>,
    density: Density,
    /// The graphics device, for other renderers.
    pub gpu: Gpu,
    pub(super) view_renderer: Option<ViewRenderer>,
    /// The named view, in use unless the free camera is.
    pub view: String,
    pub(super) camera_control: Option<CameraControl>,
    /// Elements of the picture; annotations are made for each picture.
    pub style: Style,
    pub(super) pointer: PointerState,
    drag: Option<Drag>,
    /// Samples a pixel.
    pub(super) samples: u32,
    /// Why nothing can be rendered.
    pub fault: Option<String>,
    /// Number of rendered pictures.
    pub pictures: u64,
    /// Its rectangle in the window, points.
    pub rect: Rect,
}

/// The renderer of one run.
pub(super) struct ViewRenderer {
    pub(super) fleet: Arc<FleetInfo>,
    pub(super) renderer: Renderer,
    sheet: Sheet,
    /// Renders still pictures with more samples or pixels, if the first renders with fewer, and what it renders into.
    finer: Option<(Renderer, Sheet)>,
    /// The last frame, and how well it is rendered.
    pub(super) shown: Option<(DrawnFrame, Quality)>,
    pub(super) sight: Option<Sightline>,
}

impl ViewRenderer {
    /// Renders a frame with full quality.
    fn fine(
        &mut self,
        gpu: &Gpu,
        painter: &TexturePass,
        trail: &Trail,
        record: &StepRecord,
        frame: &DrawnFrame,
    ) -> Result<(), Error> {
        let [width, height] = frame.size;
        let (mut finer, sheet) = if let Some(kept) = self.finer.take() {
            kept
        } else {
            let renderer = Renderer::with_format(gpu, &self.fleet, width, height, 4, FORMAT)?;
            (renderer, Sheet::new(gpu, painter, frame.size))
        };
        finer.resize(width, height)?;
        let sheet = if sheet.size == frame.size { sheet } else { Sheet::new(gpu, painter, frame.size) };
        finer.retitle(&frame.words[0], &frame.words[1]);
        let style = Style { interactive: false, ..frame.style.clone() };
        finer.draw_into(&sheet.view, PictureSpec::new(trail, record, &frame.layout, &style))?;
        self.finer = Some((finer, sheet));
        Ok(())
    }

    /// What is shown: the fine picture where there is one of the last frame.
    fn shown_sheet(&self) -> &Sheet {
        match (&self.shown, &self.finer) {
            (Some((_, Quality::Finer)), Some((_, sheet))) => sheet,
            _ => &self.sheet,
        }
    }
}

/// How well a frame is rendered.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Quality {
    /// It can be better when nothing moves.
    Rough,
    /// As well as it can be, by the renderer of moving pictures.
    Full,
    /// As well as it can be, by the renderer of still pictures.
    Finer,
}

/// What a picture is rendered into.
struct Sheet {
    view: wgpu::TextureView,
    /// The same, as the window reads it.
    binding: TextureBinding,
    /// Width and height, pixels.
    size: [u32; 2],
}

impl Sheet {
    fn new(gpu: &Gpu, painter: &TexturePass, [width, height]: [u32; 2]) -> Self {
        let texture = gpu.device.create_texture(&wgpu::TextureDescriptor {
            label: Some("3D view"),
            size: wgpu::Extent3d { width, height, depth_or_array_layers: 1 },
            mip_level_count: 1,
            sample_count: 1,
            dimension: wgpu::TextureDimension::D2,
            format: FORMAT,
            usage: wgpu::TextureUsages::RENDER_ATTACHMENT | wgpu::TextureUsages::TEXTURE_BINDING,
            view_formats: &[],
        });
        let view = texture.create_view(&wgpu::TextureViewDescriptor::default());
        Self { binding: painter.bind(gpu, &view), view, size: [width, height] }
    }
}

/// A picture in its place in the window: egui's own shader would filter every pixel.
struct ShownPicture {
    painter: Arc<TexturePass>,
    texture: TextureBinding,
}

impl CallbackTrait for ShownPicture {
    fn paint(&self, _: PaintCallbackInfo, pass: &mut wgpu::RenderPass<'static>, _: &CallbackResources) {
        self.painter.draw(pass, &self.texture);
    }
}

/// The inputs of a picture: it is rendered again only if they change.
#[derive(PartialEq)]
pub(super) struct DrawnFrame {
    branch: usize,
    words: [String; 2],
    time: f64,
    goals: Vec<[f64; 2]>,
    layout: ViewLayout,
    style: Style,
    size: [u32; 2],
}

impl Viewport {
    /// A view that renders on the window's device.
    pub fn new(state: &RenderState) -> Self {
        let gpu = Gpu::from_device(state.device.clone(), state.queue.clone(), &state.adapter.get_info());
        // A software driver manages one sample.
        let samples = if gpu.info().software { 1 } else { 4 };
        let style = Style { inset: false, ..Style::default() };
        Self {
            painter: Arc::new(TexturePass::new(&gpu, state.target_format)),
            stretcher: Arc::new(TexturePass::stretching(&gpu, state.target_format)),
            density: Density::of(&gpu),
            gpu,
            view_renderer: None,
            view: "snake".to_owned(),
            camera_control: None,
            style,
            pointer: PointerState::default(),
            drag: None,
            samples,
            fault: None,
            pictures: 0,
            rect: Rect::ZERO,
        }
    }

    /// Selects a named view.
    pub fn look(&mut self, view: &str) {
        view.clone_into(&mut self.view);
        self.camera_control = None;
    }

    /// Attaches the camera to a robot; `None` detaches it.
    pub fn follow(&mut self, robot: Option<usize>, app_state: &AppState) {
        let Some(record) = app_state.record() else { return };
        if self.camera_control.is_none() {
            self.take_camera(&record, robot);
        }
        if let Some(held) = &mut self.camera_control {
            match robot {
                Some(robot) => held.follow(robot),
                None => held.let_go(&record.snapshot),
            }
        }
    }

    /// The views of the picture.
    pub fn layout(&self, fleet: &FleetInfo, record: &StepRecord) -> ViewLayout {
        if let Some(held) = &self.camera_control {
            return ViewLayout::single(held.view(&record.snapshot));
        }
        let names: Vec<String> = fleet.robots.iter().map(|member| member.name.clone()).collect();
        ViewLayout::parse(&self.view, &names).unwrap_or_else(|_| ViewLayout::single(Viewpoint::Snake))
    }

    /// The style of a picture with its annotations.
    pub fn annotated_style(&self, app_state: &AppState, record: &StepRecord, scale: f64) -> Style {
        Style { scale, annotations: annotations(app_state, record, &self.pointer), ..self.style.clone() }
    }

    /// Shows the view in the available space.
    pub fn show(&mut self, ui: &mut Ui, app_state: &AppState, out: &mut Vec<Action>) {
        let (rect, response) = ui.allocate_exact_size(ui.available_size(), Sense::click_and_drag());
        response.widget_info(|| egui::WidgetInfo::labeled(egui::Role::Image, true, "3D view"));
        self.rect = rect;
        let (Some(record), Some(fleet)) = (app_state.shown(), app_state.fleet()) else {
            return centred(ui, rect, "Open a scene: Ctrl O, or drop a file here.");
        };
        self.handle_pointer(ui, &response, app_state, &record, rect, out);
        let pixels = ui.pixels_per_point();
        let size =
            [rect.width(), rect.height()].map(|s| ((s * pixels).round() as u32).clamp(SIZES[0], SIZES[1]));
        self.density.frame(ui.input(|input| input.unstable_dt), app_state.playing, size);
        if let Err(error) = self.draw(app_state, fleet, &record, size, f64::from(pixels)) {
            self.fault = Some(error.to_string());
        }
        if let Some(fault) = &self.fault {
            let text = format!("The view cannot be drawn: {fault}\nYour scene and its run are kept.");
            return centred(ui, rect, &text);
        }
        if let Some(view_renderer) = &self.view_renderer {
            let sheet = view_renderer.shown_sheet();
            let painter = if sheet.size == size { &self.painter } else { &self.stretcher };
            let picture = ShownPicture { painter: Arc::clone(painter), texture: sheet.binding.clone() };
            ui.painter().add(Callback::new_paint_callback(rect, picture));
        }
        self.readout(ui, app_state, &record, rect);
    }

    fn draw(
        &mut self,
        app_state: &AppState,
        fleet: &Arc<FleetInfo>,
        record: &Arc<StepRecord>,
        size: [u32; 2],
        pixels: f64,
    ) -> Result<(), Error> {
        // Text keeps its size in small views and scales with the screen's pixel density.
        let scale = (0.92 * pixels).clamp(0.5, 6.0);
        let layout = self.layout(fleet, record);
        let style = Style { interactive: true, ..self.annotated_style(app_state, record, scale) };
        let drawn = self.density.size(size);
        if self.view_renderer.as_ref().is_none_or(|drawn| !Arc::ptr_eq(&drawn.fleet, fleet)) {
            self.set_view_renderer(fleet, drawn)?;
        }
        let Some(view_renderer) = &mut self.view_renderer else { return Ok(()) };
        if view_renderer.sheet.size != drawn {
            view_renderer.renderer.resize(drawn[0], drawn[1])?;
            view_renderer.sheet = Sheet::new(&self.gpu, &self.painter, drawn);
            view_renderer.shown = None;
        }
        let shown = DrawnFrame {
            branch: app_state.branch,
            words: app_state.words(),
            time: record.snapshot.time,
            goals: record.edges.iter().map(|edge| edge.set_point).collect(),
            layout,
            style,
            size,
        };
        let Some(trail) = app_state.trail() else { return Ok(()) };
        if let Some((_, quality)) = view_renderer.shown.as_ref().filter(|(last, _)| *last == shown) {
            if *quality == Quality::Rough {
                // Nothing moves: there is time for a better picture.
                view_renderer.fine(&self.gpu, &self.painter, trail, record, &shown)?;
                view_renderer.shown = Some((shown, Quality::Finer));
                self.pictures += 1;
            }
            return Ok(());
        }
        let DrawnFrame { words: [title, caption], layout, style, .. } = &shown;
        let style = &Style { scale: style.scale * f64::from(drawn[1]) / f64::from(size[1]), ..style.clone() };
        let spec = PictureSpec::new(trail, record, layout, style);
        let renderer = &mut view_renderer.renderer;
        renderer.retitle(title, caption);
        view_renderer.sight = renderer.sightlines(spec)?.into_iter().next();
        renderer.draw_into(&view_renderer.sheet.view, spec)?;
        let full = self.samples > 1 && drawn == size;
        view_renderer.shown = Some((shown, if full { Quality::Full } else { Quality::Rough }));
        self.fault = None;
        self.pictures += 1;
        Ok(())
    }

    fn set_view_renderer(&mut self, fleet: &Arc<FleetInfo>, size: [u32; 2]) -> Result<(), Error> {
        let renderer = Renderer::with_format(&self.gpu, fleet, size[0], size[1], self.samples, FORMAT)?;
        self.view_renderer = Some(ViewRenderer {
            fleet: Arc::clone(fleet),
            renderer,
            sheet: Sheet::new(&self.gpu, &self.painter, size),
            finer: None,
            shown: None,
            sight: None,
        });
        Ok(())
    }

    /// Whether the shown picture can be improved when nothing moves.
    pub fn rough(&self) -> bool {
        let shown = self.view_renderer.as_ref().and_then(|view_renderer| view_renderer.shown.as_ref());
        self.fault.is_none() && shown.is_some_and(|(_, quality)| *quality == Quality::Rough)
    }

    /// Shows numbers beside the dragged ring, and the help text of the tool.
    fn readout(&self, ui: &Ui, app_state: &AppState, record: &StepRecord, rect: Rect) {
        let font = egui::FontId::proportional(14.0);
        let plate = |text: String, at: Pos2, align: egui::Align2| {
            let galley = ui.painter().layout_no_wrap(text, font.clone(), Color32::WHITE);
            let place = align.anchor_size(at, galley.size() + Vec2::new(16.0, 10.0));
            ui.painter().rect_filled(place, 6.0, Color32::from_black_alpha(190));
            ui.painter().galley(place.min + Vec2::new(8.0, 5.0), galley, Color32::WHITE);
        };
        if let Some(edge) = self.pointer.dragged
            && let Some([distance, bearing]) = app_state.set_point(edge)
            && let Some(pos) = ui.input(|input| input.pointer.latest_pos())
        {
            let text = format!("{} m   {}°", fixed(distance, 2), fixed(bearing.to_degrees(), 1));
            let error = record.edges.get(edge).map_or(0.0, |state| state.error[0].abs());
            let text = if error > 0.02 { format!("{text}\nnow {} m off", fixed(error, 2)) } else { text };
            plate(text, pos + Vec2::new(18.0, -14.0), egui::Align2::LEFT_BOTTOM);
        }
        let hint = match app_state.tool {
            Tool::Select => return,
            Tool::Connect => "Drag from a robot to its new leader. Esc cancels.",
            Tool::Pillar => "Click on the ground to place a pillar. Esc cancels.",
        };
        plate(hint.to_owned(), rect.center_top() + Vec2::new(0.0, 14.0), egui::Align2::CENTER_TOP);
    }
}

fn centred(ui: &Ui, rect: Rect, text: &str) {
    let font = egui::FontId::proportional(15.0);
    let wide = (rect.width() - 40.0).max(60.0);
    let galley = ui.painter().layout(text.to_owned(), font, ui.visuals().text_color(), wide);
    let at = rect.center() - 0.5 * galley.size();
    ui.painter().galley(at, galley, ui.visuals().text_color());
}
