//! All edges of a formation together: from what every follower sees to what every robot shall do.

use crate::column::{cartesian, column};
use crate::custom::{Custom, CustomState};
use crate::graph::Graph;
use crate::hand_over::HandOver;
use crate::law::{Law, LawInput};
use crate::memory::EdgeMemory;
use crate::narrowing::{Narrowing, Outlook};
use crate::observer::{Estimate, Observer};
use crate::path_heading::Heading;
use crate::relative::Geometry;
use crate::set_point::SetPointTrajectory;
use crate::standing::StandingInput;
use crate::tracker::TrackerParameters;
use laws::{Input, Knowledge, LeaderInput, Noise};
use std::sync::Arc;
use vocabulary::{
    Command, Edge, Limits, MotionInput, MotionPhase, Observation, Relative, SetPoint, TrackingState,
    Trajectory, math, wrap,
};

/// Parameters of one edge.
#[derive(Debug, Clone)]
pub struct EdgeLaw {
    /// The law of the follower. Where `custom` takes its place, what counts is its least distance and its heading.
    pub law: Law,
    /// The custom law of the follower. With several leaders it is that of its first edge.
    pub custom: Option<Custom>,
    /// Its observer; used where the law knows distance and bearing only.
    pub observer: Observer,
    /// How it makes an estimate from measurements; `None` where it is told the truth.
    pub tracker: Option<TrackerParameters>,
    /// Where it shall be.
    pub set_point: SetPointTrajectory,
    /// Whether [distance, bearing] are left free: nothing is wanted of them, and the set point's are not looked at.
    pub free: [bool; 2],
    /// Whether it stops with its leader and starts again; it then holds its bearing against a path's heading. Without, it
    /// never drives slower than its least speed.
    pub standing: bool,
    /// How it files in where its way is not free; it then holds its bearing against a path's heading.
    pub narrowing: Option<Narrowing>,
}

/// Parameters of a formation: they do not change as it runs but by [`Formation::apply_parameters`].
#[derive(Debug, Clone)]
pub struct Formation {
    graph: Graph,
    edges: Vec<EdgeLaw>,
    /// The set points as they were set last, by whoever sets parameters; an edge that has changed its leader has another.
    written: Vec<SetPointTrajectory>,
    limits: Vec<Limits>,
    leads: Vec<(usize, Arc<dyn Trajectory>)>,
    period: f64,
    seed: u64,
    /// Whether law and plant are one differential equation: memories of custom laws then do not change at samples.
    continuous: bool,
}

/// What a law decided on one edge. What it decided for its follower stands on each of the follower's edges.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Decision {
    /// s^d at this instant, [m, rad]: the bearing against the leader's own heading, whatever the law holds it against.
    pub set_point: [f64; 2],
    /// How far the heading that the bearing is held against is behind the leader's own, rad.
    pub behind: f64,
    /// ds^d/dt, [m/s, rad/s], of what the law works on.
    pub set_point_rate: [f64; 2],
    /// Asked for, before limits.
    pub asked: Command,
    /// Within limits: what the robot is told.
    pub commanded: Command,
    /// What takes effect at once: no acceleration outward at a bound of the speed.
    pub applied: Command,
    /// ds/dt as the law took it, [m/s, rad/s].
    pub rates: [f64; 2],
    /// Whether a limit or a filter cut the command.
    pub limited: bool,
    /// Whether the distance was below ℓ_min.
    pub too_close: bool,
    /// What the command is of.
    pub phase: MotionPhase,
    /// How far the place that the follower is driven to is from its set point, m: while it starts again after a stand, or
    /// goes to another place.
    pub displacement: f64,
    /// λ: how far the place is on the way from the set point to the column, 0 to 1.
    pub narrowing: f64,
}

/// State of a formation: observers, the last decisions, and the memory that some laws need.
#[derive(Debug, Clone)]
pub struct FormationState {
    /// Per edge.
    pub estimates: Vec<Estimate>,
    /// Per edge.
    pub decisions: Vec<Decision>,
    /// Per edge.
    pub memories: Vec<EdgeMemory>,
    /// What custom laws carry, per edge; of a follower with several leaders on its first edge.
    pub customs: Vec<CustomState>,
    /// Per robot: what it is told; for a lead robot its prescribed motion.
    pub commands: Vec<Command>,
    drives: Vec<MotionInput>,
    /// ω of the last sample and of the one before, per robot; `None` before there was one.
    turn_rates: [Option<Vec<f64>>; 2],
}

impl Formation {
    /// Puts checked parts together: `edges` in the order of the graph's edges, `limits` per robot, `leads` with the
    /// motion of every robot that follows nobody, `period` in s.
    pub fn new(
        graph: Graph,
        edges: Vec<EdgeLaw>,
        limits: Vec<Limits>,
        leads: Vec<(usize, Arc<dyn Trajectory>)>,
        period: f64,
    ) -> Self {
        debug_assert_eq!((edges.len(), limits.len()), (graph.edges().len(), graph.robots()));
        let written = edges.iter().map(|edge| edge.set_point.clone()).collect();
        let mut formation = Self { graph, edges, written, limits, leads, period, seed: 0, continuous: false };
        formation.file();
        formation
    }

    /// Draws the random numbers of custom laws by this seed.
    #[must_use]
    pub fn with_seed(self, seed: u64) -> Self {
        Self { seed, ..self }
    }

    /// Lets memories of custom laws change between samples alone, see [`Formation::evaluate`].
    #[must_use]
    pub fn in_continuous_time(self, continuous: bool) -> Self {
        Self { continuous, ..self }
    }

    /// Goes on with other laws and limits, as many as before. The set point of an edge that has changed its leader stays,
    /// unless it is another one than was set last.
    pub fn apply_parameters(&mut self, mut edges: Vec<EdgeLaw>, limits: Vec<Limits>) {
        debug_assert_eq!((edges.len(), limits.len()), (self.edges.len(), self.limits.len()));
        for ((edge, written), now) in edges.iter_mut().zip(&mut self.written).zip(&self.edges) {
            if edge.set_point == *written {
                edge.set_point.clone_from(&now.set_point);
            } else {
                written.clone_from(&edge.set_point);
            }
        }
        self.edges = edges;
        self.limits = limits;
        self.file();
    }

    /// Whom the followers of some edges follow from now on and where, or that they follow nobody. Changes nothing and
    /// returns false where somebody would then follow himself, directly or through others.
    pub fn rewire(&mut self, changes: &[(usize, Option<(usize, SetPointTrajectory)>)]) -> bool {
        let leaders: Vec<_> =
            changes.iter().map(|(edge, to)| (*edge, to.as_ref().map(|(leader, _)| *leader))).collect();
        if !self.graph.rewire(&leaders) {
            return false;
        }
        for (edge, to) in changes {
            if let Some((_, set_point)) = to {
                self.edges[*edge].set_point.clone_from(set_point);
            }
        }
        self.file();
        true
    }

    /// Gives all who narrow their places in the column of the graph as it is.
    fn file(&mut self) {
        let filings: Vec<_> = self.edges.iter().map(|edge| edge.narrowing.map(|rule| rule.filing)).collect();
        if filings.iter().all(Option::is_none) {
            return;
        }
        let places: Vec<_> = self.edges.iter().map(|edge| cartesian(edge.set_point.at(0.0).value)).collect();
        let columns = column(&self.graph, &places, &filings);
        for (edge, place) in self.edges.iter_mut().zip(columns) {
            if let Some(rule) = &mut edge.narrowing {
                rule.column = place;
            }
        }
    }

    /// A robot follows nobody from now on and has this motion, or has none of its own any more.
    pub fn set_lead(&mut self, robot: usize, motion: Option<Arc<dyn Trajectory>>) {
        self.leads.retain(|(lead, _)| *lead != robot);
        self.leads.extend(motion.map(|motion| (robot, motion)));
    }

    /// The bounds of a robot from now on.
    pub fn set_limits(&mut self, robot: usize, limits: Limits) {
        self.limits[robot] = limits;
    }

    /// The graph.
    pub fn graph(&self) -> &Graph {
        &self.graph
    }

    /// Who follows whom.
    pub fn edges(&self) -> &[Edge] {
        self.graph.edges()
    }

    /// Parameters of every edge, in the order of [`Formation::edges`].
    pub fn laws(&self) -> &[EdgeLaw] {
        &self.edges
    }

    /// Limits of a robot.
    pub fn limits(&self, robot: usize) -> &Limits {
        &self.limits[robot]
    }

    /// Robots that follow nobody, with their motion.
    pub fn leads(&self) -> &[(usize, Arc<dyn Trajectory>)] {
        &self.leads
    }

    /// The state before the first sample; observers start where `estimates` says, one per edge.
    pub fn start(&self, estimates: Vec<Estimate>) -> FormationState {
        let robots = self.graph.robots();
        FormationState {
            estimates,
            decisions: vec![Decision::default(); self.edges.len()],
            memories: vec![EdgeMemory::default(); self.edges.len()],
            customs: vec![CustomState::default(); self.edges.len()],
            commands: vec![Command::default(); robots],
            drives: vec![MotionInput::default(); robots],
            turn_rates: [None, None],
        }
    }

    /// Decides the commands of one control sample at `time` s from one observation per edge.
    pub fn decide(&self, time: f64, observations: &[Observation], state: &mut FormationState) {
        self.decide_through(time, observations, state, &mut |_, command| command);
    }

    /// As [`Formation::decide`], where a robot is told what `filter` makes of its command. Followers of that robot go by
    /// what it is told.
    pub fn decide_through(
        &self,
        time: f64,
        observations: &[Observation],
        state: &mut FormationState,
        filter: &mut dyn FnMut(usize, Command) -> Command,
    ) {
        self.remember(time, observations, state);
        state.differentiate_turn_rates(self.period);
        let mut rates = self.continuous.then(|| vec![vec![]; self.edges.len()]);
        self.evaluate_through(time, observations, state, filter, rates.as_deref_mut());
        state.remember_turn_rates();
    }

    /// Carries what followers remember of their leaders on to this sample.
    fn remember(&self, time: f64, observations: &[Observation], state: &mut FormationState) {
        for (index, (edge, seen)) in self.edges.iter().zip(observations).enumerate() {
            let memory = &mut state.memories[index];
            // Whoever comes into sight again is met anew.
            if unseen(seen) {
                memory.forget();
                state.customs[index].forget();
                continue;
            }
            let rates = || {
                let geometry = Geometry::new(&seen.relative, edge.law.distance_min);
                let leader =
                    MotionInput { speed: seen.leader_speed.unwrap_or(0.0), ..MotionInput::default() };
                edge.rates_of(&state.estimates[index], || {
                    edge.law.rates(&geometry, seen.own_speed, &leader).into()
                })
            };
            if edge.law.heading.filter().is_some() {
                let rates = rates();
                memory.advance(&edge.law, seen, rates, self.period);
                match &edge.narrowing {
                    Some(rule) => {
                        memory.narrowing.carry(rule, &edge.set_point.at(time), memory.speed, self.period);
                    }
                    None => memory.narrowing.give_back(self.period),
                }
            } else if *memory != EdgeMemory::default() {
                *memory = EdgeMemory { hand_over: memory.hand_over, ..EdgeMemory::default() };
            }
            if memory.hand_over.is_some() {
                edge.go_over(memory, time, seen, rates(), self.period);
            }
            if edge.standing {
                let turn_rate = state.decisions[index].applied.turn_rate;
                edge.stand(memory, time, seen, turn_rate, self.period);
            }
        }
    }

    /// Evaluates all laws at an instant of continuous time, leaders before followers. Memories stay; those of custom laws have
    /// the time derivatives `rates`, per edge.
    pub fn evaluate(
        &self,
        time: f64,
        observations: &[Observation],
        state: &mut FormationState,
        rates: &mut [Vec<f64>],
    ) {
        self.evaluate_through(time, observations, state, &mut |_, command| command, Some(rates));
    }

    fn evaluate_through(
        &self,
        time: f64,
        observations: &[Observation],
        state: &mut FormationState,
        filter: &mut dyn FnMut(usize, Command) -> Command,
        mut rates: Option<&mut [Vec<f64>]>,
    ) {
        for (robot, trajectory) in &self.leads {
            let mut drive = trajectory.at(time);
            let prescribed = Command { acceleration: drive.acceleration, turn_rate: drive.turn_rate };
            let told = filter(*robot, prescribed);
            if told != prescribed {
                drive.acceleration = told.acceleration;
                drive.turn_rate = told.turn_rate;
                drive.turn_acceleration = state.drives[*robot].turn_acceleration;
            }
            state.drives[*robot] = drive;
            state.commands[*robot] = told;
        }
        for &index in self.graph.evaluation_order() {
            let follower = self.edges()[index].follower;
            let own = self.graph.edges_of(follower);
            // A follower with several leaders decides once.
            if own[0] != index {
                continue;
            }
            let rates = rates.as_mut().map(|all| &mut all[index]);
            self.decide_follower(own, time, observations, state, rates);
            let commanded = state.decisions[index].commanded;
            let (told, own_speed) = (filter(follower, commanded), observations[index].own_speed);
            if told != commanded {
                for edge in own {
                    state.decisions[*edge].divert(told, own_speed, &self.limits[follower]);
                }
            }
            let applied = state.decisions[index].applied;
            let drive = &mut state.drives[follower];
            drive.speed = own_speed;
            drive.acceleration = applied.acceleration;
            drive.turn_rate = applied.turn_rate;
            state.commands[follower] = told;
        }
    }

    /// Decides the command of the follower whose edges are `own`. `rates` become those of a custom law's memory, in
    /// continuous time.
    fn decide_follower(
        &self,
        own: &[usize],
        time: f64,
        observations: &[Observation],
        state: &mut FormationState,
        rates: Option<&mut Vec<f64>>,
    ) {
        let first = own[0];
        let limits = &self.limits[self.edges()[first].follower];
        if let Some(blind) = own.iter().map(|edge| &observations[*edge]).find(|seen| unseen(seen)) {
            let told = without_leader(blind.sight == TrackingState::Lost, blind.own_speed, limits);
            for edge in own {
                let set_point = self.edges[*edge].set_point.at(time);
                state.decisions[*edge] = Decision::of(told, &set_point, blind.own_speed, limits);
            }
            return;
        }
        let view = |edge: &usize| self.view(*edge, time, &observations[*edge], state);
        let (alone, several);
        let views = if let [edge] = own {
            alone = view(edge);
            std::slice::from_ref(&alone)
        } else {
            several = own.iter().map(view).collect::<Vec<_>>();
            &several
        };
        let (parameters, seen) = (&self.edges[first], &observations[first]);
        let asked = match &parameters.custom {
            None => Some(parameters.law.command(&views[0].law_input())),
            Some(custom) => self.ask(custom, first, time, views, state, rates),
        };
        // A law that has broken off leaves its follower as if it had lost its leader.
        let mut asked = asked.unwrap_or_else(|| without_leader(true, seen.own_speed, limits));
        let mut phase = MotionPhase::Law;
        let memory = &mut state.memories[first];
        if let Some(input) = parameters.standing_input(memory, &views[0].place, seen) {
            let leader = [memory.speed_now(), memory.acceleration];
            let input = StandingInput { leader, ..input };
            (asked, phase) = memory.standing.command(asked, &input);
        }
        if let Some(hand_over) = &mut memory.hand_over {
            asked = hand_over.command(asked);
        }
        for (edge, view) in own.iter().zip(views) {
            let seen = &observations[*edge];
            let decision = Decision::of(asked, &view.set_point, seen.own_speed, limits);
            state.decisions[*edge] =
                Decision { phase, ..self.on_edge(*edge, time, view, seen, &state.memories[*edge], decision) };
        }
    }

    /// What the law of a follower looks at on one of its edges.
    fn view(&self, index: usize, time: f64, seen: &Observation, state: &FormationState) -> EdgeView {
        let (edge, parameters) = (self.edges()[index], &self.edges[index]);
        // What the leader does within this sample it tells its follower; its speed the follower has to observe.
        let leader = MotionInput { speed: seen.leader_speed.unwrap_or(0.0), ..state.drives[edge.leader] };
        let (law, memory) = (&parameters.law, &state.memories[index]);
        let geometry = Geometry::new(&seen.relative, law.distance_min);
        let output = law.heading.output(&seen.relative, seen.own_heading);
        let place = parameters.place(memory, time);
        let mut set_point = parameters.output_set_point(memory, &place);
        for (k, at) in [output.distance, output.bearing].into_iter().enumerate() {
            if parameters.free[k] {
                (set_point.value[k], set_point.rate[k], set_point.acceleration[k]) = (at, 0.0, 0.0);
            }
        }
        let slowest = if parameters.standing { DIVIDES_BY } else { self.limits[edge.follower].speed_min };
        let own_speed = seen.own_speed.max(slowest);
        let truth = || law.rates(&geometry, own_speed, &leader).into();
        let rates = parameters.rates_of(&state.estimates[index], truth);
        EdgeView {
            geometry,
            output,
            bearing: seen.relative.bearing,
            place,
            set_point,
            rates,
            own_speed,
            leader,
        }
    }

    /// The command that a custom law asks for on the edges of its follower; `None` where it has broken off.
    fn ask(
        &self,
        custom: &Custom,
        first: usize,
        time: f64,
        views: &[EdgeView],
        state: &mut FormationState,
        rates: Option<&mut Vec<f64>>,
    ) -> Option<Command> {
        let law = &self.edges[first].law;
        let (alone, several);
        let leaders = if let [view] = views {
            alone = view.leader_input(law);
            std::slice::from_ref(&alone)
        } else {
            several = views.iter().map(|view| view.leader_input(law)).collect::<Vec<_>>();
            &several
        };
        let follower = self.edges()[first].follower;
        let last = state.decisions[first].applied;
        let input = Input {
            time,
            period: self.period,
            own_speed: views[0].own_speed,
            own_acceleration: last.acceleration,
            own_turn_rate: last.turn_rate,
            leaders,
            noise: Noise {
                seed: self.seed,
                robot: follower as u64,
                sample: (time / self.period).round() as u64,
            },
        };
        let law = &mut state.customs[first];
        match rates {
            None => law.decide(custom, &input),
            Some(rates) => law.derive(custom, &input, rates),
        }
    }

    /// A decision with what belongs to one edge.
    fn on_edge(
        &self,
        index: usize,
        time: f64,
        view: &EdgeView,
        seen: &Observation,
        memory: &EdgeMemory,
        mut decision: Decision,
    ) -> Decision {
        let parameters = &self.edges[index];
        if let Some(heading) = memory.heading {
            decision.behind = heading.behind;
            decision.set_point[1] = wrap(view.place.value[1] - heading.behind);
        }
        let narrowing = parameters.narrowing.as_ref();
        let narrowing =
            narrowing.map_or(0.0, |rule| memory.narrowing.share(rule, &parameters.set_point.at(time)));
        let too_close = seen.relative.distance < parameters.law.distance_min;
        let displacement = memory.displacement();
        Decision { rates: view.rates, too_close, displacement, narrowing, ..decision }
    }
}

/// What the law of a follower looks at on one edge.
struct EdgeView {
    geometry: Geometry,
    /// What the law works on.
    output: Relative,
    /// Bearing from the leader's own heading, rad.
    bearing: f64,
    /// s^d against the heading it is held against.
    place: SetPoint,
    /// s^d of what the law works on.
    set_point: SetPoint,
    /// Rates of what the law works on, as the follower knows them.
    rates: [f64; 2],
    own_speed: f64,
    leader: MotionInput,
}

impl EdgeView {
    fn law_input(&self) -> LawInput<'_> {
        LawInput {
            geometry: &self.geometry,
            error: tracking_error(&self.set_point, &self.output),
            set_point: &self.set_point,
            rates: self.rates,
            own_speed: self.own_speed,
            leader: &self.leader,
        }
    }

    fn leader_input(&self, law: &Law) -> LeaderInput {
        LeaderInput {
            relative: Relative { distance: self.geometry.distance, ..self.output },
            rates: self.rates,
            wanted: self.set_point,
            motion: self.leader,
            frame: match law.heading {
                Heading::Leader => [self.leader.turn_rate, self.leader.turn_acceleration],
                Heading::Path(_) => [0.0; 2],
            },
            heading: wrap(self.output.bearing - self.bearing),
        }
    }
}

impl Formation {
    /// Followers that narrow look for room; before [`Formation::decide`]. `free` is asked of a follower, a place in the world's
    /// directions from its pose, m, and a radius, m, whether that circle is free of all that the follower senses.
    pub fn look(
        &self,
        time: f64,
        observations: &[Observation],
        state: &mut FormationState,
        free: &mut dyn FnMut(usize, [f64; 2], f64) -> bool,
    ) {
        for (index, (edge, seen)) in self.edges.iter().zip(observations).enumerate() {
            let memory = &mut state.memories[index];
            if let (Some(rule), Some(outlook)) = (&edge.narrowing, edge.outlook(memory, time, seen)) {
                let follower = self.graph.edges()[index].follower;
                let mut free = |place, radius| free(follower, place, radius);
                memory.narrowing.look(rule, &outlook, self.period, &mut free);
            }
        }
    }
}

/// The least speed by which a law divides that may stand, m/s: near it the law has no part in the command.
const DIVIDES_BY: f64 = 0.01;

impl EdgeLaw {
    /// What the follower's law has to know of its leader.
    pub fn knows(&self) -> Knowledge {
        self.custom.as_ref().map_or(self.law.knows(), |custom| custom.law().declaration().knows)
    }

    /// Whether the follower's law takes the rates of distance and bearing from its observer.
    pub fn observes(&self) -> bool {
        self.knows() == Knowledge::Output
    }

    /// ds/dt as the law takes it: the observer's `estimate`, or the truth for a law that is told it.
    fn rates_of(&self, estimate: &Estimate, truth: impl FnOnce() -> [f64; 2]) -> [f64; 2] {
        if self.observes() { estimate.rates } else { truth() }
    }

    /// s^d where the follower has filed in, as far as it has.
    fn narrowed(&self, memory: &EdgeMemory, time: f64) -> SetPoint {
        memory.narrowing.moves(&self.set_point.at(time), self.law.distance_min)
    }

    /// s^d against the heading it is held against, as it is while the follower goes to its place.
    fn way(&self, memory: &EdgeMemory, time: f64) -> SetPoint {
        let base = self.narrowed(memory, time);
        let hand_over = memory.hand_over.as_ref();
        hand_over.map_or(base, |hand_over| hand_over.set_point(&base, self.law.distance_min))
    }

    /// s^d against the heading it is held against.
    fn place(&self, memory: &EdgeMemory, time: f64) -> SetPoint {
        let base = self.way(memory, time);
        if self.standing { memory.standing.set_point(&base, self.law.distance_min) } else { base }
    }

    /// [distance, bearing] of a follower in m and rad, against the heading that its bearing is held against.
    fn seen_place(&self, memory: &EdgeMemory, seen: &Observation) -> [f64; 2] {
        let bearing = match memory.heading.filter(|_| self.law.heading.filter().is_some()) {
            Some(heading) => wrap(seen.relative.view_angle + seen.own_heading - heading.heading),
            None => seen.relative.bearing,
        };
        [seen.relative.distance, bearing]
    }

    /// Carries a hand-over on over a period; `rates` are those of what the law works on.
    fn go_over(
        &self,
        memory: &mut EdgeMemory,
        time: f64,
        seen: &Observation,
        [closing, turning]: [f64; 2],
        period: f64,
    ) {
        let (at, goal) = (self.seen_place(memory, seen), self.narrowed(memory, time).value);
        let turns = self.law.heading.filter().zip(memory.heading.as_ref());
        let moving =
            [closing, turning - turns.map_or(0.0, |(filter, heading)| heading.rate(filter, memory.speed))];
        let waits = memory.standing.holds();
        let goes_on = |hand_over: &mut HandOver| hand_over.advance(at, moving, goal, waits, period);
        if memory.hand_over.as_mut().is_some_and(|hand_over| !goes_on(hand_over)) {
            memory.hand_over = None;
        }
    }

    /// Where a follower that narrows looks for room, once it knows how its leader drives.
    fn outlook(&self, memory: &EdgeMemory, time: f64, seen: &Observation) -> Option<Outlook> {
        let (filter, heading) = (self.law.heading.filter()?, memory.heading.filter(|_| !unseen(seen))?);
        // From the leader to the follower.
        let direction = seen.relative.view_angle + seen.own_heading;
        let (sin, cos) = math::sin_cos(direction);
        let distance = seen.relative.distance;
        Some(Outlook {
            wide: cartesian(self.set_point.at(time).value),
            ahead: distance * math::cos(direction - heading.heading),
            leader: [-distance * cos, -distance * sin],
            heading: heading.heading + heading.behind,
            behind: heading.behind,
            curvature: (heading.curvature + filter.gain() * heading.behind).clamp(-1.0, 1.0),
            speed: memory.speed,
        })
    }

    /// s^d as the law takes it: with a path's heading, φ^d = ψ^d + θ̄ in place of ψ^d.
    fn output_set_point(&self, memory: &EdgeMemory, place: &SetPoint) -> SetPoint {
        let (Some(filter), Some(heading)) = (self.law.heading.filter(), &memory.heading) else {
            return *place;
        };
        let mut set_point = *place;
        set_point.value[1] += heading.heading;
        set_point.rate[1] += heading.rate(filter, memory.speed);
        set_point
    }

    /// What the standing rule looks at, where it is on.
    fn standing_input<'a>(
        &self,
        memory: &EdgeMemory,
        place: &'a SetPoint,
        seen: &Observation,
    ) -> Option<StandingInput<'a>> {
        let (filter, heading) = (self.law.heading.filter()?, memory.heading.filter(|_| self.standing)?);
        Some(StandingInput {
            set_point: place,
            frame: [wrap(heading.heading - seen.own_heading), heading.rate(filter, memory.speed)],
            place: self.seen_place(memory, seen),
            own_speed: seen.own_speed,
            leader: [memory.speed, memory.acceleration],
        })
    }

    /// Carries the standing rule on over a period; `turn_rate` rad/s is what was applied last.
    fn stand(&self, memory: &mut EdgeMemory, time: f64, seen: &Observation, turn_rate: f64, period: f64) {
        memory.standing.carry(memory.speed, period);
        let (base, place) = (self.way(memory, time), self.place(memory, time));
        if let Some(input) = self.standing_input(memory, &place, seen) {
            memory.standing.switch(&base, &input, turn_rate, period);
        }
    }
}

/// Whether a follower does not know where its leader is.
fn unseen(seen: &Observation) -> bool {
    matches!(seen.sight, TrackingState::Waiting | TrackingState::Lost)
}

impl Decision {
    /// What becomes of what is asked for at a speed, within limits.
    fn of(asked: Command, set_point: &SetPoint, own_speed: f64, limits: &Limits) -> Self {
        let commanded = limits.saturate(asked, own_speed.max(limits.speed_min));
        let acceleration = limits.admissible(commanded.acceleration, own_speed);
        let applied = Command { acceleration, ..commanded };
        Self {
            set_point: [set_point.value[0], wrap(set_point.value[1])],
            set_point_rate: set_point.rate,
            asked,
            commanded,
            applied,
            limited: applied != asked,
            ..Self::default()
        }
    }

    /// Puts another command in the place of the one that was decided.
    fn divert(&mut self, told: Command, own_speed: f64, limits: &Limits) {
        let acceleration = limits.admissible(told.acceleration, own_speed);
        self.commanded = told;
        self.applied = Command { acceleration, ..told };
        self.limited = true;
    }
}

/// What a follower asks for that has not seen its leader yet: it goes straight on; one that has `lost` it brakes to its
/// slowest speed besides.
fn without_leader(lost: bool, own_speed: f64, limits: &Limits) -> Command {
    let braking = (limits.speed_min - own_speed) / BRAKING;
    Command { acceleration: if lost { braking } else { 0.0 }, turn_rate: 0.0 }
}

/// Time constant with which a follower brakes that has lost its leader, s.
const BRAKING: f64 = 0.5;

/// e = s^d − s, [m, rad], bearing wrapped (eq 14).
fn tracking_error(set_point: &SetPoint, output: &Relative) -> [f64; 2] {
    [set_point.value[0] - output.distance, wrap(set_point.value[1] - output.bearing)]
}

impl FormationState {
    /// The follower of edge number `index` has another leader from now on, of whose relative position and motion it
    /// believes `estimate`.
    pub fn change_leader(&mut self, index: usize, law: &Law, estimate: Estimate, hand_over: HandOver) {
        self.estimates[index] = estimate;
        self.customs[index].forget();
        let turn_rate = hand_over.last().turn_rate;
        self.memories[index].change_leader(law, hand_over, turn_rate);
    }

    /// dω/dt of a robot that is itself commanded: the difference of its last two commands, zero before there are two.
    fn differentiate_turn_rates(&mut self, period: f64) {
        let [Some(last), Some(before)] = &self.turn_rates else { return };
        for ((drive, last), before) in self.drives.iter_mut().zip(last).zip(before) {
            drive.turn_acceleration = (last - before) / period;
        }
    }

    fn remember_turn_rates(&mut self) {
        self.turn_rates.swap(0, 1);
        let last = self.turn_rates[0].get_or_insert_with(Vec::new);
        last.clear();
        last.extend(self.drives.iter().map(|d| d.turn_rate));
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::law::Switching;
    use crate::lead::AnalyticTrajectory;
    use laws::{CustomLaw, Declaration, Fault, Parameter, Quantity, Scale, Unit};
    use vocabulary::LawKind;

    fn chain(kind: LawKind) -> Formation {
        let graph = Graph::new(&["a", "b", "c"], &[("a", "b"), ("b", "c")]).expect("a chain");
        let law = Law {
            kind,
            gain: [5.0; 2],
            robust_gain: [5.0; 2],
            switching: Switching::Tanh([24.53; 2]),
            distance_min: 0.1,
            heading: Heading::Leader,
        };
        let observer = Observer { epsilon: [1e-3; 2], alpha1: [2.0; 2], alpha2: [1.0; 2], distance_min: 0.1 };
        let edge = EdgeLaw {
            law,
            custom: None,
            observer,
            tracker: None,
            set_point: SetPointTrajectory::constant(2.0, -2.3),
            free: [false; 2],
            standing: false,
            narrowing: None,
        };
        let limits = Limits::PAPER;
        let lead: Arc<dyn Trajectory> = Arc::new(AnalyticTrajectory::constant(1.0, 0.3));
        Formation::new(graph, vec![edge.clone(), edge], vec![limits; 3], vec![(0, lead)], 0.01)
    }

    fn observation(distance: f64) -> Observation {
        let relative = Relative { distance, bearing: -2.29, view_angle: -2.29 };
        Observation { relative, own_speed: 1.0, leader_speed: Some(1.0), ..Observation::default() }
    }

    #[test]
    fn full_state_feedback_differentiates_its_leaders_command_from_the_third_sample_on() {
        let formation = chain(LawKind::FullState);
        let mut state = formation.start(vec![Estimate::default(); 2]);
        let mut turn_rates = vec![];
        for (k, distance) in [1.97, 1.98, 2.0].into_iter().enumerate() {
            let expected = if k < 2 { 0.0 } else { (turn_rates[1] - turn_rates[0]) / 0.01 };
            formation.decide(k as f64 * 0.01, &[observation(distance), observation(2.0)], &mut state);
            assert_eq!(state.drives[1].turn_acceleration, expected, "sample {k}");
            turn_rates.push(state.commands[1].turn_rate);
        }
        assert_ne!(turn_rates[0], turn_rates[1]);
    }

    #[test]
    fn a_lead_robot_is_told_its_prescribed_motion() {
        let formation = chain(LawKind::RobustState);
        let mut state = formation.start(vec![Estimate::default(); 2]);
        formation.decide(0.0, &[observation(2.0); 2], &mut state);
        assert_eq!(state.commands[0], Command { acceleration: 0.0, turn_rate: 0.3 });
    }

    #[test]
    fn followers_go_by_what_their_leader_was_told_after_a_filter() {
        let formation = chain(LawKind::FullState);
        let free = Command { acceleration: 0.0, turn_rate: 0.3 };
        let told = Command { acceleration: -0.7, turn_rate: 0.9 };
        let mut states = [0, 1].map(|_| formation.start(vec![Estimate::default(); 2]));
        let seen = [observation(2.0); 2];
        let mut asked = vec![];
        formation.decide(0.0, &seen, &mut states[0]);
        formation.decide_through(0.0, &seen, &mut states[1], &mut |robot, command| {
            asked.push((robot, command));
            if robot == 0 { told } else { command }
        });
        assert_eq!(asked[0], (0, free));
        assert_eq!((states[1].commands[0], states[1].drives[0].turn_rate), (told, 0.9));
        assert_ne!(states[0].commands[1], states[1].commands[1]);
        // The memory that full state feedback differentiates holds what was told.
        for k in 1..3 {
            let mut turn = |robot: usize, command| match robot {
                0 => Command { turn_rate: 0.9 + 0.1 * f64::from(k), ..told },
                _ => command,
            };
            formation.decide_through(0.0, &seen, &mut states[1], &mut turn);
        }
        formation
            .decide_through(0.0, &seen, &mut states[1], &mut |robot, c| if robot == 0 { told } else { c });
        assert!((states[1].drives[0].turn_acceleration - 10.0).abs() < 1e-9);
    }

    #[test]
    fn output_feedback_takes_its_rates_from_the_observer_and_reports_limits() {
        let formation = chain(LawKind::OutputFeedback);
        let estimate = Estimate { output: [2.0, -2.0], rates: [100.0, -50.0] };
        let mut state = formation.start(vec![estimate; 2]);
        let near = observation(0.05);
        formation.decide(0.0, &[near, near], &mut state);
        assert_eq!(state.decisions[0].rates, [100.0, -50.0]);
        assert!(state.decisions[0].limited && state.decisions[0].too_close);
        assert!(state.commands[1].turn_rate.abs() <= 11.5);
    }

    /// A law in Rust: it asks for the sum of its leaders' distances and for what it has counted, and breaks off where it
    /// counts beyond a bound.
    #[derive(Debug)]
    struct Counting(Declaration);

    impl Counting {
        fn new(leaders: usize) -> Arc<Self> {
            let quantity = |name: &str| Quantity { name: name.to_owned(), unit: Unit::NUMBER };
            let parameter = Parameter {
                name: "bound".to_owned(),
                symbol: "b".to_owned(),
                unit: Unit::NUMBER,
                default: 3.0,
                range: [0.0, 10.0],
                scale: Scale::Linear,
                help: String::new(),
            };
            Arc::new(Self(Declaration {
                leaders,
                knows: Knowledge::Motion,
                parameters: vec![parameter],
                memory: vec![quantity("count")],
                shown: vec![quantity("sample")],
                ..Declaration::default()
            }))
        }
    }

    impl CustomLaw for Counting {
        fn declaration(&self) -> &Declaration {
            &self.0
        }

        fn start(&self, _: &Input<'_>, _: &[f64], memory: &mut [f64]) -> Result<(), Fault> {
            memory[0] = 1.0;
            Ok(())
        }

        fn decide(
            &self,
            input: &Input<'_>,
            parameters: &[f64],
            memory: &mut [f64],
            shown: &mut [f64],
        ) -> Result<Command, Fault> {
            shown[0] = input.noise.sample as f64;
            memory[0] += 1.0;
            if memory[0] > parameters[0] {
                return Err(Fault { place: None, message: "it has counted too far".to_owned() });
            }
            let acceleration = input.leaders.iter().map(|leader| leader.relative.distance).sum();
            Ok(Command { acceleration, turn_rate: memory[0] })
        }

        fn derive(
            &self,
            input: &Input<'_>,
            parameters: &[f64],
            memory: &[f64],
            rates: &mut [f64],
        ) -> Result<Command, Fault> {
            rates[0] = 1.0;
            self.decide(input, parameters, &mut memory.to_vec(), &mut [0.0])
        }
    }

    /// c keeps its place by `leaders` with a counting law; the others do as always.
    fn counting(leaders: &[&str]) -> Formation {
        let mut formation = chain(LawKind::FullState);
        let pairs: Vec<_> =
            [("a", "b")].into_iter().chain(leaders.iter().map(|leader| (*leader, "c"))).collect();
        formation.graph = Graph::new(&["a", "b", "c"], &pairs).expect("a graph");
        let edge = formation.edges[1].clone();
        let custom = Some(Custom::new(Counting::new(leaders.len()), vec![3.0]));
        formation.edges.truncate(1);
        formation.edges.extend(leaders.iter().map(|_| EdgeLaw { custom: custom.clone(), ..edge.clone() }));
        formation.edges[leaders.len()].free = [false, true];
        formation.written = formation.edges.iter().map(|edge| edge.set_point.clone()).collect();
        formation
    }

    #[test]
    fn a_custom_law_decides_once_for_all_its_leaders_and_carries_its_memory() {
        let formation = counting(&["a", "b"]);
        let mut state = formation.start(vec![Estimate::default(); 3]);
        let seen = [observation(2.0), observation(0.25), observation(0.5)];
        for k in 0..2 {
            formation.decide(f64::from(k) * 0.01, &seen, &mut state);
        }
        let asked = Command { acceleration: 0.75, turn_rate: 3.0 };
        assert_eq!([1, 2].map(|edge| state.decisions[edge].asked), [asked; 2]);
        assert_eq!(state.commands[2], asked);
        assert_eq!((state.customs[1].memory(), state.customs[1].shown()), (&[3.0][..], &[1.0][..]));
        // Of a set point that is left free nothing is wanted.
        assert_eq!(state.decisions[2].set_point[1], seen[2].relative.bearing);
        assert_ne!(state.decisions[1].set_point[1], seen[1].relative.bearing);
    }

    #[test]
    fn a_law_that_breaks_off_leaves_its_follower_braking_until_it_is_changed() {
        let mut formation = counting(&["b"]);
        let mut state = formation.start(vec![Estimate::default(); 2]);
        let mut decide = |formation: &Formation, k: u32| {
            formation.decide(f64::from(k) * 0.01, &[observation(2.0), observation(0.5)], &mut state);
            let law = &state.customs[1];
            (state.commands[2], law.fault().is_some(), law.is_failed(), law.memory()[0])
        };
        decide(&formation, 0);
        decide(&formation, 1);
        let braking = Command { acceleration: (Limits::PAPER.speed_min - 1.0) / BRAKING, turn_rate: 0.0 };
        assert_eq!(decide(&formation, 2), (braking, true, true, 3.0));
        assert_eq!(decide(&formation, 3), (braking, false, true, 3.0));
        // With other parameters it goes on where it was; another law with the same memory takes that over.
        let law = Counting::new(1);
        formation.edges[1].custom = Some(Custom::new(law.clone(), vec![4.0]));
        assert_eq!(decide(&formation, 4), (Command { acceleration: 0.5, turn_rate: 4.0 }, false, false, 4.0));
        formation.edges[1].custom = Some(Custom::new(law, vec![9.0]));
        assert_eq!(decide(&formation, 5).3, 5.0);
    }

    #[test]
    fn a_leader_that_is_met_anew_starts_the_memory_anew() {
        let formation = counting(&["b"]);
        let mut state = formation.start(vec![Estimate::default(); 2]);
        let lost = Observation { sight: TrackingState::Lost, ..observation(0.5) };
        for seen in [observation(0.5), lost, observation(0.5)] {
            formation.decide(0.0, &[observation(2.0), seen], &mut state);
        }
        assert_eq!(state.customs[1].memory(), [2.0]);
    }

    #[test]
    fn in_continuous_time_samples_leave_the_memory_as_it_is() {
        let formation = counting(&["b"]).in_continuous_time(true);
        let mut state = formation.start(vec![Estimate::default(); 2]);
        let seen = [observation(2.0), observation(0.5)];
        for _ in 0..5 {
            formation.decide(0.0, &seen, &mut state);
        }
        let mut rates = vec![vec![]; 2];
        formation.evaluate(0.0, &seen, &mut state, &mut rates);
        assert_eq!((state.customs[1].memory(), &rates[1][..]), (&[1.0][..], &[1.0][..]));
    }
}
