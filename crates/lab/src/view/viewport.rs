//! The 3D view in its tile: drawn when something in it has changed, and under the hand.

use super::camera::HeldCamera;
use super::sketching::{Hand, set_points, sketch};
use crate::action::Action;
use crate::desk::{Choice, Desk, Tool};
use crate::tidy::{fixed, snap};
use eframe::egui::{self, Color32, Pos2, Rect, Sense, TextureId, Ui, Vec2};
use eframe::egui_wgpu::RenderState;
use rendering::{Error, Gpu, Layout, Picked, Renderer, Sightline, Style, Trail, View};
use std::sync::Arc;
use vocabulary::{Cast, Moment, wrap};

/// Steps of a set point under the hand: m and degrees.
const STEPS: [f64; 2] = [0.1, 5.0];
/// How near to a ring's middle the pointer grasps it, points.
const GRASP: f32 = 16.0;
/// Rooms for pixels of the view, both ways.
const SIZES: [u32; 2] = [16, 8192];

/// The 3D view.
pub struct Viewport {
    state: RenderState,
    gpu: Gpu,
    stage: Option<Stage>,
    /// What is looked from: a named view, or the camera in the hand.
    pub view: String,
    held: Option<HeldCamera>,
    /// What is drawn besides the scene; its sketch is made anew for each picture.
    pub style: Style,
    hand: Hand,
    drag: Option<Drag>,
    /// Samples a pixel.
    samples: u32,
    /// Why nothing can be drawn.
    pub fault: Option<String>,
    /// Pictures drawn so far.
    pub pictures: u64,
    /// Where it is in the window, points.
    pub rect: Rect,
}

/// What draws the robots of one run.
struct Stage {
    cast: Arc<Cast>,
    renderer: Renderer,
    texture: wgpu::Texture,
    id: TextureId,
    /// Draws what stands still with more samples, where the first draws with one.
    finer: Option<Renderer>,
    /// What was drawn last, and whether as well as can be.
    shown: Option<(Shown, bool)>,
    sight: Option<Sightline>,
}

impl Stage {
    /// Draws with all samples.
    fn fine(
        &mut self,
        gpu: &Gpu,
        (trail, moment): (&Trail, &Moment),
        (layout, style): (&Layout, &Style),
        [title, caption]: &[String; 2],
    ) -> Result<(), Error> {
        let (width, height) = self.renderer.size();
        let finer = match self.finer.take() {
            Some(mut finer) => {
                finer.resize(width, height)?;
                finer
            }
            None => {
                Renderer::with_format(gpu, &self.cast, width, height, 4, wgpu::TextureFormat::Rgba8Unorm)?
            }
        };
        let finer = self.finer.insert(finer);
        finer.retitle(title, caption);
        let view = self.texture.create_view(&wgpu::TextureViewDescriptor::default());
        finer.draw_into(&view, trail, moment, layout, style).map(drop)
    }
}

/// What a picture was made of: where nothing of it has changed, it stands.
#[derive(PartialEq)]
struct Shown {
    branch: usize,
    words: [String; 2],
    time: f64,
    goals: Vec<[f64; 2]>,
    layout: Layout,
    style: Style,
    size: (u32, u32),
}

/// What a button held down moves.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Drag {
    Orbit,
    Pan,
    SetPoint(usize),
    Connect(usize),
}

impl Viewport {
    /// A view that draws on the window's device.
    pub fn new(state: &RenderState) -> Self {
        let gpu = Gpu::from_device(state.device.clone(), state.queue.clone(), &state.adapter.get_info());
        // A processor that draws has enough to do with one sample.
        let samples = if gpu.info().software { 1 } else { 4 };
        let style = Style { inset: false, ..Style::default() };
        Self {
            state: state.clone(),
            gpu,
            stage: None,
            view: "snake".to_owned(),
            held: None,
            style,
            hand: Hand::default(),
            drag: None,
            samples,
            fault: None,
            pictures: 0,
            rect: Rect::ZERO,
        }
    }

    /// The device, for whoever else draws.
    pub fn gpu(&self) -> &Gpu {
        &self.gpu
    }

    /// Looks from a view called this.
    pub fn look(&mut self, view: &str) {
        view.clone_into(&mut self.view);
        self.held = None;
    }

    /// Keeps the camera with a robot; `None` lets it go.
    pub fn follow(&mut self, robot: Option<usize>, desk: &Desk) {
        let Some(moment) = desk.moment() else { return };
        if self.held.is_none() {
            self.take_camera(&moment, robot);
        }
        if let Some(held) = &mut self.held {
            match robot {
                Some(robot) => held.follow(robot),
                None => held.let_go(&moment.snapshot),
            }
        }
    }

    /// Views of the picture.
    pub fn layout(&self, cast: &Cast, moment: &Moment) -> Layout {
        if let Some(held) = &self.held {
            return Layout::single(held.view(&moment.snapshot));
        }
        let names: Vec<String> = cast.members.iter().map(|member| member.name.clone()).collect();
        Layout::parse(&self.view, &names).unwrap_or_else(|_| Layout::single(View::Snake))
    }

    /// The style of a picture with all that explains it.
    pub fn dressed(&self, desk: &Desk, moment: &Moment, scale: f64) -> Style {
        Style { scale, sketch: sketch(desk, moment, &self.hand), ..self.style.clone() }
    }

    /// The view in all the room there is.
    pub fn show(&mut self, ui: &mut Ui, desk: &DeskView<'_>, out: &mut Vec<Action>) {
        let (rect, response) = ui.allocate_exact_size(ui.available_size(), Sense::click_and_drag());
        response.widget_info(|| egui::WidgetInfo::labeled(egui::Role::Image, true, "3D view"));
        ui.painter().rect_filled(rect, 0.0, ui.visuals().extreme_bg_color);
        self.rect = rect;
        let Some(moment) = desk.moment.clone() else {
            let text = desk.desk.notice.as_deref().unwrap_or("Open a scene: Ctrl O, or drop a file here.");
            return centred(ui, rect, text);
        };
        self.under_hand(ui, &response, (desk.desk, &moment), rect, out);
        let pixels = ui.pixels_per_point();
        let size =
            [rect.width(), rect.height()].map(|s| ((s * pixels).round() as u32).clamp(SIZES[0], SIZES[1]));
        if let Err(error) = self.draw(desk, &moment, (size[0], size[1]), f64::from(pixels)) {
            self.fault = Some(error.to_string());
        }
        if let Some(fault) = &self.fault {
            return centred(
                ui,
                rect,
                &format!("The view cannot be drawn: {fault}\nYour scene and its run are kept."),
            );
        }
        if let Some(stage) = &self.stage {
            let whole = Rect::from_min_max(Pos2::ZERO, Pos2::new(1.0, 1.0));
            ui.painter().image(stage.id, rect, whole, Color32::WHITE);
        }
        self.readout(ui, desk.desk, &moment, rect);
    }

    fn draw(
        &mut self,
        desk: &DeskView<'_>,
        moment: &Arc<Moment>,
        size: (u32, u32),
        pixels: f64,
    ) -> Result<(), Error> {
        let cast = Arc::clone(desk.cast);
        // Text keeps its size on small views, and grows with the density of the screen.
        let scale = (0.92 * pixels).clamp(0.5, 6.0);
        let layout = self.layout(&cast, moment);
        let style = Style { interactive: true, ..self.dressed(desk.desk, moment, scale) };
        if self.stage.as_ref().is_none_or(|stage| !Arc::ptr_eq(&stage.cast, &cast)) {
            self.set_stage(&cast, size)?;
        }
        let Some(stage) = &mut self.stage else { return Ok(()) };
        if stage.renderer.size() != size {
            stage.renderer.resize(size.0, size.1)?;
            stage.texture = texture(&self.state.device, size);
            let view = stage.texture.create_view(&wgpu::TextureViewDescriptor::default());
            self.state.renderer.write().update_egui_texture_from_wgpu_texture(
                &self.state.device,
                &view,
                wgpu::FilterMode::Nearest,
                stage.id,
            );
            stage.shown = None;
        }
        let shown = Shown {
            branch: desk.desk.branch,
            words: desk.desk.words(),
            time: moment.snapshot.time,
            goals: moment.edges.iter().map(|edge| edge.set_point).collect(),
            layout: layout.clone(),
            style: style.clone(),
            size,
        };
        let Some(trail) = desk.trail else { return Ok(()) };
        match &stage.shown {
            Some((last, true)) if *last == shown => return Ok(()),
            Some((last, false)) if *last == shown => {
                // Nothing moves any more: there is time for a better picture.
                let fine = Style { interactive: false, ..style };
                stage.fine(&self.gpu, (trail, moment), (&layout, &fine), &shown.words)?;
                stage.shown = Some((shown, true));
                self.pictures += 1;
                return Ok(());
            }
            _ => {}
        }
        let [title, caption] = &shown.words;
        stage.renderer.retitle(title, caption);
        stage.sight = stage.renderer.sightlines(trail, moment, &layout, &style)?.into_iter().next();
        let view = stage.texture.create_view(&wgpu::TextureViewDescriptor::default());
        stage.renderer.draw_into(&view, trail, moment, &layout, &style)?;
        stage.shown = Some((shown, self.samples > 1));
        self.fault = None;
        self.pictures += 1;
        Ok(())
    }

    fn set_stage(&mut self, cast: &Arc<Cast>, size: (u32, u32)) -> Result<(), Error> {
        let format = wgpu::TextureFormat::Rgba8Unorm;
        let renderer = Renderer::with_format(&self.gpu, cast, size.0, size.1, self.samples, format)?;
        let texture = texture(&self.state.device, size);
        let view = texture.create_view(&wgpu::TextureViewDescriptor::default());
        let mut drawer = self.state.renderer.write();
        if let Some(before) = self.stage.take() {
            drawer.free_texture(&before.id);
        }
        let id = drawer.register_native_texture(&self.state.device, &view, wgpu::FilterMode::Nearest);
        drop(drawer);
        self.stage = Some(Stage {
            cast: Arc::clone(cast),
            renderer,
            texture,
            id,
            finer: None,
            shown: None,
            sight: None,
        });
        Ok(())
    }

    /// Whether what is seen could be drawn better when nothing moves.
    pub fn rough(&self) -> bool {
        let shown = self.stage.as_ref().and_then(|stage| stage.shown.as_ref());
        self.fault.is_none() && shown.is_some_and(|(_, fine)| !fine)
    }

    /// Everything the pointer does in the view.
    fn under_hand(
        &mut self,
        ui: &Ui,
        response: &egui::Response,
        (desk, moment): (&Desk, &Arc<Moment>),
        rect: Rect,
        out: &mut Vec<Action>,
    ) {
        let pixels = ui.pixels_per_point();
        let pixel = |pos: Pos2| [pos.x - rect.left(), pos.y - rect.top()].map(|x| f64::from(x * pixels));
        let Some(sight) = self.stage.as_ref().and_then(|stage| stage.sight.clone()) else { return };
        let pointer = response.hover_pos().or_else(|| response.interact_pointer_pos());
        self.hover(desk, moment, (&sight, pointer.map(pixel)), f64::from(pixels * GRASP));
        if response.drag_started() {
            self.begin_drag(ui, desk);
        }
        let share = |delta: Vec2| [delta.x, delta.y].map(|x| f64::from(x / rect.height().max(1.0)));
        if let (Some(drag), Some(pos)) = (self.drag, response.interact_pointer_pos()) {
            let delta = response.drag_delta();
            match drag {
                Drag::Orbit | Drag::Pan if delta == Vec2::ZERO => {}
                Drag::Orbit => {
                    self.take_camera(moment, None);
                    if let Some(held) = &mut self.held {
                        held.orbit(share(delta));
                    }
                }
                Drag::Pan => {
                    let (from, to) = (sight.ground(pixel(pos - delta)), sight.ground(pixel(pos)));
                    self.take_camera(moment, None);
                    if let (Some(held), Some(from), Some(to)) = (&mut self.held, from, to) {
                        held.pan(from, to);
                    }
                }
                Drag::SetPoint(edge) => {
                    if let Some(place) = sight.ground(pixel(pos)) {
                        out.extend(dragged(ui, desk, moment, edge, place));
                    }
                }
                Drag::Connect(robot) => {
                    self.hand.connecting = sight.ground(pixel(pos)).map(|place| (robot, place));
                }
            }
        }
        if response.drag_stopped() {
            self.end_drag(out);
        }
        self.wheel(ui, response, (&sight, pointer.map(pixel)), moment);
        self.clicks(response, desk, (&sight, pointer.map(pixel)), out);
    }

    /// What is under the pointer.
    fn hover(
        &mut self,
        desk: &Desk,
        moment: &Moment,
        (sight, pixel): (&Sightline, Option<[f64; 2]>),
        grasp: f64,
    ) {
        self.hand.over = None;
        self.hand.robot = None;
        let (Some(pixel), Some(stage)) = (pixel, &self.stage) else { return };
        let near = set_points(&stage.cast, moment).into_iter().enumerate().filter_map(|(edge, at)| {
            let [x, y] = sight.pixel_of_ground(at?)?;
            let away = (x - pixel[0]).hypot(y - pixel[1]);
            let radius = super::sketching::RING / sight.metres_per_pixel([at?[0], at?[1], 0.0]).max(1e-9);
            (away < grasp.max(0.8 * radius)).then_some((away, edge))
        });
        // The set point that is selected comes before those that it lies under.
        let first =
            |(away, edge): &(f64, usize)| if desk.chosen_edge() == Some(*edge) { 0.5 * away } else { *away };
        if desk.tool == Tool::Hand {
            self.hand.over = near.min_by(|a, b| first(a).total_cmp(&first(b))).map(|(_, edge)| edge);
        }
        let robot = stage.renderer.pick(sight, moment, pixel).into_iter().find_map(|picked| match picked {
            Picked::Robot(robot) => Some(robot),
            _ => None,
        });
        self.hand.robot = robot;
    }

    fn begin_drag(&mut self, ui: &Ui, desk: &Desk) {
        let (right, shift) = ui.input(|input| {
            let pointer = &input.pointer;
            (pointer.secondary_down() || pointer.middle_down(), input.modifiers.shift)
        });
        self.drag = Some(match (right, desk.tool, self.hand.robot, self.hand.over) {
            (true, ..) => Drag::Pan,
            (_, Tool::Connect, Some(robot), _) => Drag::Connect(robot),
            (_, Tool::Hand, _, Some(edge)) => Drag::SetPoint(edge),
            _ if shift => Drag::Pan,
            _ => Drag::Orbit,
        });
        if let Some(Drag::SetPoint(edge)) = self.drag {
            self.hand.held = Some(edge);
        }
    }

    fn end_drag(&mut self, out: &mut Vec<Action>) {
        match self.drag.take() {
            Some(Drag::SetPoint(edge)) => {
                out.push(Action::Rest);
                out.push(Action::Choose(Choice::Edge(edge)));
            }
            Some(Drag::Connect(follower)) => {
                if let Some(leader) = self.hand.robot.filter(|leader| *leader != follower) {
                    out.push(Action::Connect { leader, follower });
                }
            }
            _ => {}
        }
        self.hand.held = None;
        self.hand.connecting = None;
    }

    fn wheel(
        &mut self,
        ui: &Ui,
        response: &egui::Response,
        (sight, pixel): (&Sightline, Option<[f64; 2]>),
        moment: &Moment,
    ) {
        if !response.hovered() {
            return;
        }
        let (scroll, pinch) = ui.input(|input| (input.smooth_scroll_delta().y, input.zoom_delta()));
        let factor = f64::from((-scroll * 0.004).exp() / pinch.max(1e-3));
        if (factor - 1.0).abs() > 1e-4 {
            let about = pixel.and_then(|pixel| sight.ground(pixel));
            self.take_camera(moment, None);
            if let Some(held) = &mut self.held {
                held.zoom(factor, about, &moment.snapshot);
            }
        }
    }

    fn clicks(
        &self,
        response: &egui::Response,
        desk: &Desk,
        (sight, pixel): (&Sightline, Option<[f64; 2]>),
        out: &mut Vec<Action>,
    ) {
        let Some(pixel) = pixel else { return };
        if response.double_clicked() {
            if let Some(robot) = self.hand.robot {
                out.push(Action::Follow(Some(robot)));
            }
        } else if response.clicked() {
            match (desk.tool, sight.ground(pixel)) {
                (Tool::Pillar, Some(place)) => out.push(Action::AddProp("pillar", place)),
                _ => out.extend(self.chosen(sight, desk, pixel)),
            }
        }
    }

    fn chosen(&self, sight: &Sightline, desk: &Desk, pixel: [f64; 2]) -> Option<Action> {
        if let Some(edge) = self.hand.over {
            return Some(Action::Choose(Choice::Edge(edge)));
        }
        let stage = self.stage.as_ref()?;
        let picked = stage.renderer.pick(sight, &*desk.moment()?, pixel).into_iter().next()?;
        Some(Action::Choose(match picked {
            Picked::Robot(robot) => Choice::Robot(robot),
            Picked::Edge(edge) | Picked::SetPoint(edge) => Choice::Edge(edge),
        }))
    }

    /// The hand takes the camera over from a named view.
    fn take_camera(&mut self, moment: &Moment, robot: Option<usize>) {
        if self.held.is_some() {
            return;
        }
        let Some(stage) = &self.stage else { return };
        let lead = stage.cast.members.iter().position(|member| member.leads);
        if let Some(sight) = &stage.sight {
            self.held = Some(HeldCamera::take(sight.free(), robot.or(lead), &moment.snapshot));
        }
    }

    /// Numbers beside the ring that is dragged, and what the tool does.
    fn readout(&self, ui: &Ui, desk: &Desk, moment: &Moment, rect: Rect) {
        let font = egui::FontId::proportional(14.0);
        let plate = |text: String, at: Pos2, align: egui::Align2| {
            let galley = ui.painter().layout_no_wrap(text, font.clone(), Color32::WHITE);
            let place = align.anchor_size(at, galley.size() + Vec2::new(16.0, 10.0));
            ui.painter().rect_filled(place, 6.0, Color32::from_black_alpha(190));
            ui.painter().galley(place.min + Vec2::new(8.0, 5.0), galley, Color32::WHITE);
        };
        if let Some(edge) = self.hand.held
            && let Some([distance, bearing]) = desk.set_point(edge)
            && let Some(pos) = ui.input(|input| input.pointer.latest_pos())
        {
            let text = format!("{} m   {}°", fixed(distance, 2), fixed(bearing.to_degrees(), 1));
            let error = moment.edges.get(edge).map_or(0.0, |state| state.error[0].abs());
            let text = if error > 0.02 { format!("{text}\nnow {} m off", fixed(error, 2)) } else { text };
            plate(text, pos + Vec2::new(18.0, -14.0), egui::Align2::LEFT_BOTTOM);
        }
        let hint = match desk.tool {
            Tool::Hand => return,
            Tool::Connect => "Drag from a robot to the one that it shall follow. Esc ends it.",
            Tool::Pillar => "Click on the ground to place a pillar. Esc ends it.",
        };
        plate(hint.to_owned(), rect.center_top() + Vec2::new(0.0, 14.0), egui::Align2::CENTER_TOP);
    }
}

/// What the view needs of the desk, borrowed in parts.
pub struct DeskView<'a> {
    /// All of it.
    pub desk: &'a Desk,
    /// Who is on stage.
    pub cast: &'a Arc<Cast>,
    /// What is looked at.
    pub moment: Option<Arc<Moment>>,
    /// The past of it.
    pub trail: Option<&'a Trail>,
}

/// What a set point that is dragged to a place asks for.
fn dragged(ui: &Ui, desk: &Desk, moment: &Moment, edge: usize, place: [f64; 2]) -> Option<Action> {
    let ends = *desk.history.as_ref()?.cast().edges.get(edge)?;
    let leader = moment.snapshot.robots.get(ends.leader)?.motion.pose;
    let [dx, dy] = [place[0] - leader.x, place[1] - leader.y];
    let (distance, bearing) = (dx.hypot(dy), wrap(dy.atan2(dx) - leader.heading));
    let least = desk.follower(edge).map_or(0.1, |(_, _, follow)| follow.law.distance_min);
    let (free, whole) = ui.input(|input| (input.modifiers.shift, input.modifiers.command));
    let [distance, bearing] = if free {
        [distance, bearing]
    } else {
        [snap(distance, STEPS[0]), wrap(snap(bearing.to_degrees(), STEPS[1]).to_radians())]
    };
    let distance = distance.max(least.max(0.1));
    let [now_distance, now_bearing] = desk.set_point(edge)?;
    if (distance - now_distance).abs() < 1e-9 && wrap(bearing - now_bearing).abs() < 1e-9 {
        return None;
    }
    Some(if whole {
        Action::Shape { scale: distance / now_distance.max(1e-6), turn: wrap(bearing - now_bearing) }
    } else {
        Action::SetPoint { edge, distance, bearing }
    })
}

fn texture(device: &wgpu::Device, (width, height): (u32, u32)) -> wgpu::Texture {
    device.create_texture(&wgpu::TextureDescriptor {
        label: Some("3D view"),
        size: wgpu::Extent3d { width, height, depth_or_array_layers: 1 },
        mip_level_count: 1,
        sample_count: 1,
        dimension: wgpu::TextureDimension::D2,
        format: wgpu::TextureFormat::Rgba8Unorm,
        usage: wgpu::TextureUsages::RENDER_ATTACHMENT | wgpu::TextureUsages::TEXTURE_BINDING,
        view_formats: &[],
    })
}

fn centred(ui: &Ui, rect: Rect, text: &str) {
    let font = egui::FontId::proportional(15.0);
    let wide = (rect.width() - 40.0).max(60.0);
    let galley = ui.painter().layout(text.to_owned(), font, ui.visuals().text_color(), wide);
    let at = rect.center() - 0.5 * galley.size();
    ui.painter().galley(at, galley, ui.visuals().text_color());
}
