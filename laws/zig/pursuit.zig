//! Pursuit in Zig: turns towards the leader and keeps a distance, as the first law of docs/law-files.md.

/// What a law is told of one leader, in m, s and rad: as in laws/c/echelon_law.h.
const Leader = extern struct {
    distance: f64,
    bearing: f64,
    view_angle: f64,
    distance_rate: f64,
    bearing_rate: f64,
    wanted_distance: f64,
    wanted_bearing: f64,
    wanted_distance_rate: f64,
    wanted_bearing_rate: f64,
    wanted_distance_acceleration: f64,
    wanted_bearing_acceleration: f64,
    speed: f64,
    acceleration: f64,
    turn_rate: f64,
    turn_acceleration: f64,
    heading: f64,
    frame_turn_rate: f64,
    frame_turn_acceleration: f64,
};

const Told = extern struct {
    time: f64,
    period: f64,
    own_speed: f64,
    own_acceleration: f64,
    own_turn_rate: f64,
    leader: Leader,
};

const Command = extern struct { acceleration: f64, turn_rate: f64 };

extern "env" fn wrap(angle: f64) f64;

var room: [1024]f64 = undefined;

export fn region() *[1024]f64 {
    return &room;
}

export fn declaration() [*:0]const u8 {
    return
        \\{ "title": "Pursuit, in Zig",
        \\  "parameters": [{ "name": "k", "unit": "1/s", "default": 2, "range": [0.1, 20],
        \\                   "help": "double pole of the distance error" }] }
    ;
}

const Parameters = extern struct { k: f64 };

export fn decide(told: *const Told, own: *const Parameters, _: *anyopaque, _: *anyopaque, command: *Command) void {
    const leader = &told.leader;
    const e = leader.wanted_distance - leader.distance;
    const de = leader.wanted_distance_rate - leader.distance_rate;
    const towards = wrap(leader.view_angle - 3.141592653589793);
    command.acceleration = -(own.k * own.k) * e - 2 * own.k * de;
    command.turn_rate = own.k * towards;
}
