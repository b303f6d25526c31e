//! The 3D view in its tile: it is rendered when its content has changed.

mod pointer;

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

/// Minimum and maximum size of the view, pixels.
const SIZES: [u32; 2] = [16, 8192];

/// The 3D view.
pub struct Viewport {
    /// Lays pictures into the window.
    painter: Arc<TexturePass>,
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
    pub(super) texture: wgpu::TextureView,
    /// The same, as the window reads it.
    binding: TextureBinding,
    /// Renders still pictures with more samples, if the first renders with one.
    pub(super) finer: Option<Renderer>,
    /// The last frame, and whether it has full quality.
    pub(super) shown: Option<(DrawnFrame, bool)>,
    pub(super) sight: Option<Sightline>,
}

impl ViewRenderer {
    /// Renders a frame with full quality.
    fn fine(
        &mut self,
        gpu: &Gpu,
        trail: &Trail,
        record: &StepRecord,
        frame: &DrawnFrame,
    ) -> Result<(), Error> {
        let [width, height] = frame.size;
        let finer = match self.finer.take() {
            Some(mut finer) => {
                finer.resize(width, height)?;
                finer
            }
            None => {
                Renderer::with_format(gpu, &self.fleet, width, height, 4, wgpu::TextureFormat::Rgba8Unorm)?
            }
        };
        let finer = self.finer.insert(finer);
        finer.retitle(&frame.words[0], &frame.words[1]);
        let style = Style { interactive: false, ..frame.style.clone() };
        finer.draw_into(&self.texture, PictureSpec::new(trail, record, &frame.layout, &style)).map(drop)
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
        if let Err(error) = self.draw(app_state, fleet, &record, size, f64::from(pixels)) {
            self.fault = Some(error.to_string());
        }
        if let Some(fault) = &self.fault {
            let text = format!("The view cannot be drawn: {fault}\nYour scene and its run are kept.");
            return centred(ui, rect, &text);
        }
        if let Some(view_renderer) = &self.view_renderer {
            let picture =
                ShownPicture { painter: Arc::clone(&self.painter), texture: view_renderer.binding.clone() };
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
        if self.view_renderer.as_ref().is_none_or(|drawn| !Arc::ptr_eq(&drawn.fleet, fleet)) {
            self.set_view_renderer(fleet, size)?;
        }
        let Some(view_renderer) = &mut self.view_renderer else { return Ok(()) };
        if view_renderer.renderer.size() != size {
            view_renderer.renderer.resize(size[0], size[1])?;
            view_renderer.texture = texture(&self.gpu.device, size);
            view_renderer.binding = self.painter.bind(&self.gpu, &view_renderer.texture);
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
        if let Some((_, fine)) = view_renderer.shown.as_ref().filter(|(last, _)| *last == shown) {
            if !fine {
                // Nothing moves: there is time for a better picture.
                view_renderer.fine(&self.gpu, trail, record, &shown)?;
                view_renderer.shown = Some((shown, true));
                self.pictures += 1;
            }
            return Ok(());
        }
        let DrawnFrame { words: [title, caption], layout, style, .. } = &shown;
        let spec = PictureSpec::new(trail, record, layout, style);
        let renderer = &mut view_renderer.renderer;
        renderer.retitle(title, caption);
        view_renderer.sight = renderer.sightlines(spec)?.into_iter().next();
        renderer.draw_into(&view_renderer.texture, spec)?;
        view_renderer.shown = Some((shown, self.samples > 1));
        self.fault = None;
        self.pictures += 1;
        Ok(())
    }

    fn set_view_renderer(&mut self, fleet: &Arc<FleetInfo>, size: [u32; 2]) -> Result<(), Error> {
        let format = wgpu::TextureFormat::Rgba8Unorm;
        let renderer = Renderer::with_format(&self.gpu, fleet, size[0], size[1], self.samples, format)?;
        let texture = texture(&self.gpu.device, size);
        self.view_renderer = Some(ViewRenderer {
            fleet: Arc::clone(fleet),
            renderer,
            binding: self.painter.bind(&self.gpu, &texture),
            texture,
            finer: None,
            shown: None,
            sight: None,
        });
        Ok(())
    }

    /// Whether the shown picture can be improved when nothing moves.
    pub fn rough(&self) -> bool {
        let shown = self.view_renderer.as_ref().and_then(|view_renderer| view_renderer.shown.as_ref());
        self.fault.is_none() && shown.is_some_and(|(_, fine)| !fine)
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

fn texture(device: &wgpu::Device, [width, height]: [u32; 2]) -> wgpu::TextureView {
    let texture = device.create_texture(&wgpu::TextureDescriptor {
        label: Some("3D view"),
        size: wgpu::Extent3d { width, height, depth_or_array_layers: 1 },
        mip_level_count: 1,
        sample_count: 1,
        dimension: wgpu::TextureDimension::D2,
        format: wgpu::TextureFormat::Rgba8Unorm,
        usage: wgpu::TextureUsages::RENDER_ATTACHMENT | wgpu::TextureUsages::TEXTURE_BINDING,
        view_formats: &[],
    });
    texture.create_view(&wgpu::TextureViewDescriptor::default())
}

fn centred(ui: &Ui, rect: Rect, text: &str) {
    let font = egui::FontId::proportional(15.0);
    let wide = (rect.width() - 40.0).max(60.0);
    let galley = ui.painter().layout(text.to_owned(), font, ui.visuals().text_color(), wide);
    let at = rect.center() - 0.5 * galley.size();
    ui.painter().galley(at, galley, ui.visuals().text_color());
}
