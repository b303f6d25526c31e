//! All edges of a formation together: from what every follower sees to what every robot shall do.

use crate::agent_action::AgentAction;
use crate::column::{cartesian, column};
use crate::custom::{Custom, CustomState};
use crate::decision::{Decision, without_leader};
use crate::edge_law::{EdgeLaw, unseen};
use crate::edge_view::EdgeView;
use crate::graph::Graph;
use crate::hand_over::HandOver;
use crate::law::Law;
use crate::memory::EdgeMemory;
use crate::observer::Estimate;
use crate::relative::Geometry;
use crate::set_point::SetPointTrajectory;
use crate::standing::StandingInput;
use laws::{BatchInput, BatchLaw, Input, Knowledge, LeaderInput, Noise};
use std::sync::Arc;
use vocabulary::{
    Command, Edge, Limits, MotionInput, MotionPhase, Observation, TrackingState, Trajectory, wrap,
};

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
    /// Per robot: what a law for many followers asked for last; `None` where none did.
    batch: Vec<Option<Command>>,
    /// Per robot: what somebody outside decides for it at the next decision.
    actions: Vec<Option<AgentAction>>,
    /// Whether [`Formation::prepare`] has carried memories on to the sample that is decided next.
    prepared: bool,
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
            batch: vec![None; robots],
            actions: vec![None; robots],
            prepared: false,
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
        self.begin(time, observations, state);
        let mut rates = self.continuous.then(|| vec![vec![]; self.edges.len()]);
        self.evaluate_through(time, observations, state, filter, rates.as_deref_mut());
        state.remember_turn_rates();
    }

    /// As [`Formation::decide_through`], where `batch` decides for the followers whose [`EdgeLaw::batch`] says so.
    ///
    /// # Errors
    /// [`laws::Fault`] where it gives no commands; `state` is then of no use.
    pub fn decide_with(
        &self,
        time: f64,
        observations: &[Observation],
        state: &mut FormationState,
        batch: &mut dyn BatchLaw,
        filter: &mut dyn FnMut(usize, Command) -> Command,
    ) -> Result<(), laws::Fault> {
        self.begin(time, observations, state);
        self.lead(time, state, filter);
        let stages = match batch.knows() {
            Knowledge::Output => vec![self.graph.evaluation_order().to_vec()],
            Knowledge::Rates | Knowledge::Motion => self.graph.depths(),
        };
        for stage in &stages {
            self.ask_batch(batch, stage, time, observations, state)?;
            self.follow(stage, time, observations, state, filter, None);
        }
        state.remember_turn_rates();
        Ok(())
    }

    fn begin(&self, time: f64, observations: &[Observation], state: &mut FormationState) {
        if !std::mem::take(&mut state.prepared) {
            self.remember(time, observations, state);
            state.differentiate_turn_rates(self.period);
        }
    }

    /// Carries on to this sample what followers remember, so that [`Formation::told`] tells of it; the decision of the same
    /// sample, which comes next, does not do it again.
    pub fn prepare(&self, time: f64, observations: &[Observation], state: &mut FormationState) {
        self.begin(time, observations, state);
        state.prepared = true;
    }

    /// Hands to `read` what the law of edge number `index` is told at a sample that is prepared, and the tracking error, [m, rad],
    /// as the follower knows it. Of what leaders do within the sample nothing is known yet: their motion is that of the sample
    /// before.
    pub fn told<R>(
        &self,
        index: usize,
        time: f64,
        seen: &Observation,
        state: &FormationState,
        read: impl FnOnce(&Input<'_>, [f64; 2]) -> R,
    ) -> R {
        let view = self.view(index, time, seen, state);
        let leaders = [view.leader_input(&self.edges[index].law)];
        read(&self.input(index, time, view.own_speed, &leaders, state), view.error())
    }

    /// True tracking error of edge number `index` at a sample that is prepared, [m, rad]; `truth` is the true relative position.
    pub fn true_error(
        &self,
        index: usize,
        time: f64,
        truth: &Observation,
        state: &FormationState,
    ) -> [f64; 2] {
        self.view(index, time, truth, state).error()
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
        rates: Option<&mut [Vec<f64>]>,
    ) {
        self.lead(time, state, filter);
        self.follow(self.graph.evaluation_order(), time, observations, state, filter, rates);
    }

    /// Those who follow nobody take their prescribed motion.
    fn lead(&self, time: f64, state: &mut FormationState, filter: &mut dyn FnMut(usize, Command) -> Command) {
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
    }

    /// The followers of the edges `order` decide, one after the other.
    fn follow(
        &self,
        order: &[usize],
        time: f64,
        observations: &[Observation],
        state: &mut FormationState,
        filter: &mut dyn FnMut(usize, Command) -> Command,
        mut rates: Option<&mut [Vec<f64>]>,
    ) {
        for &index in order {
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
        let follower = self.edges()[first].follower;
        let action = state.actions[follower].take();
        let by_law = || match &parameters.custom {
            _ if parameters.batch.is_some() => state.batch[follower],
            None => Some(parameters.law.command(&views[0].law_input())),
            Some(custom) => self.ask(custom, first, time, views, state, rates),
        };
        let asked = match action {
            None => by_law(),
            Some(action) => action.applied_to(by_law),
        };
        // A law that has broken off leaves its follower as if it had lost its leader.
        let mut asked = asked.unwrap_or_else(|| without_leader(true, seen.own_speed, limits));
        let mut phase = MotionPhase::Law;
        let memory = &mut state.memories[first];
        if let Some(input) = parameters.standing_input(memory, &views[0].place, seen) {
            let leader = [memory.speed_now(), memory.acceleration];
            let steered = limits.curvature_max.is_finite();
            let turns_at_most = if steered { limits.turn_rate_at(seen.own_speed) } else { f64::INFINITY };
            let input = StandingInput { leader, turns_at_most, ..input };
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
        let input = self.input(first, time, views[0].own_speed, leaders, state);
        let law = &mut state.customs[first];
        match rates {
            None => law.decide(custom, &input),
            Some(rates) => law.derive(custom, &input, rates),
        }
    }

    /// What the law of the follower of edge number `first` is told.
    fn input<'a>(
        &self,
        first: usize,
        time: f64,
        own_speed: f64,
        leaders: &'a [LeaderInput],
        state: &FormationState,
    ) -> Input<'a> {
        let last = state.decisions[first].applied;
        Input {
            time,
            period: self.period,
            own_speed,
            own_acceleration: last.acceleration,
            own_turn_rate: last.turn_rate,
            leaders,
            noise: Noise {
                seed: self.seed,
                robot: self.edges()[first].follower as u64,
                sample: (time / self.period).round() as u64,
            },
        }
    }

    /// Asks `batch` for the commands of its followers among those of the edges `stage`; those who do not know where their
    /// leader is are left out.
    fn ask_batch(
        &self,
        batch: &mut dyn BatchLaw,
        stage: &[usize],
        time: f64,
        observations: &[Observation],
        state: &mut FormationState,
    ) -> Result<(), laws::Fault> {
        let asked = |edge: &usize| self.edges[*edge].batch.is_some() && !unseen(&observations[*edge]);
        let mut edges: Vec<usize> = stage.iter().copied().filter(asked).collect();
        edges.sort_by_key(|edge| self.edges()[*edge].follower);
        let view = |edge: &usize| self.view(*edge, time, &observations[*edge], state);
        let views: Vec<EdgeView> = edges.iter().map(view).collect();
        let leader = |(edge, view): (&usize, &EdgeView)| view.leader_input(&self.edges[*edge].law);
        let leaders: Vec<LeaderInput> = edges.iter().zip(&views).map(leader).collect();
        let mut inputs = Vec::with_capacity(edges.len());
        for ((edge, view), leader) in edges.iter().zip(&views).zip(leaders.chunks(1)) {
            inputs.push(BatchInput {
                robot: self.edges()[*edge].follower,
                meets: state.customs[*edge].meets(),
                input: self.input(*edge, time, view.own_speed, leader, state),
            });
        }
        if inputs.is_empty() {
            return Ok(());
        }
        let commands = batch.decide(&inputs)?;
        for (input, command) in inputs.iter().zip(commands) {
            state.batch[input.robot] = Some(command);
        }
        Ok(())
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

impl FormationState {
    /// Somebody outside decides for a robot at the next decision; a robot that has no law then ignores it.
    pub fn set_action(&mut self, robot: usize, action: AgentAction) {
        self.actions[robot] = Some(action);
    }

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
mod tests;
