/* Output feedback (eq 42) in C: the same law as laws/output-feedback.law, which says what it computes. */
#include "echelon_law.h"

const char *declaration(void) {
    return LAW_JSON({
        "title": "Output feedback (eq 42), in C",
        "parameters": [
            { "name": "k1", "unit": "1/s", "default": 5, "range": [0.1, 20],
              "help": "double pole of the distance error" },
            { "name": "k2", "unit": "1/s", "default": 5, "range": [0.1, 20],
              "help": "double pole of the bearing error" },
            { "name": "beta1", "unit": "m/s^2", "default": 5, "range": [0, 20],
              "help": "size of the robust term of the distance" },
            { "name": "beta2", "unit": "rad/s^2", "default": 5, "range": [0, 20],
              "help": "size of the robust term of the bearing" },
            { "name": "kappa1", "unit": "1/m", "default": 24.53, "range": [1, 200],
              "scale": "logarithmic", "help": "its slope" },
            { "name": "kappa2", "unit": "1/rad", "default": 24.53, "range": [1, 200],
              "scale": "logarithmic", "help": "its slope" }
        ],
        "shown": [{ "name": "e_distance", "unit": "m" }, { "name": "e_bearing", "unit": "rad" }]
    });
}

struct parameters {
    double k1, k2, beta1, beta2, kappa1, kappa2;
};

struct shown {
    double e_distance, e_bearing;
};

void decide(const struct told *told, const struct parameters *own, struct memory *memory, struct shown *shown,
            struct command *command) {
    const struct leader *leader = &told->leader[0];
    const double l = leader->distance, v = told->own_speed;
    const double sg = sin(leader->view_angle), cg = cos(leader->view_angle);
    const double e1 = leader->wanted_distance - l;
    const double e2 = wrap(leader->wanted_bearing - leader->bearing);
    const double de1 = leader->wanted_distance_rate - leader->distance_rate;
    const double de2 = leader->wanted_bearing_rate - leader->bearing_rate;

    const double b1 = leader->wanted_distance_acceleration - v * v / l + v * cg / l * leader->distance_rate +
                      2 * own->k1 * de1 + own->k1 * own->k1 * e1 + own->beta1 * tanh(own->kappa1 * e1);
    const double b2 = leader->wanted_bearing_acceleration - 2 * v * sg / (l * l) * leader->distance_rate +
                      2 * own->k2 * de2 + own->k2 * own->k2 * e2 + own->beta2 * tanh(own->kappa2 * e2);

    shown->e_distance = e1;
    shown->e_bearing = e2;
    command->acceleration = cg * b1 - sg * l * b2;
    command->turn_rate = (sg * b1 + cg * l * b2) / v;
}
