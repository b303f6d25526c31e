/* A control law for Echelon, in C: docs/law-modules.md.
 *
 * Include this in the one file of the law, define the structs of your numbers, `declaration` and `decide`, and build with
 *
 *     clang --target=wasm32 -nostdlib -O2 -ffreestanding -Wl,--no-entry -o mine.wasm mine.c
 */
#ifndef ECHELON_LAW_H
#define ECHELON_LAW_H

#define LAW_EXPORT(name) __attribute__((export_name(#name)))
#define LAW_IMPORT(name) __attribute__((import_module("env"), import_name(#name)))

/* What a law is told of one leader, in m, s and rad. */
struct leader {
    double distance, bearing, view_angle;
    double distance_rate, bearing_rate;
    double wanted_distance, wanted_bearing;
    double wanted_distance_rate, wanted_bearing_rate;
    double wanted_distance_acceleration, wanted_bearing_acceleration;
    /* Told to laws that know "motion" only. */
    double speed, acceleration, turn_rate, turn_acceleration;
    double heading, frame_turn_rate, frame_turn_acceleration;
};

/* What a law is told at an instant, in m, s and rad. */
struct told {
    double time, period;
    double own_speed, own_acceleration, own_turn_rate;
    struct leader leader[4]; /* as many as are declared */
};

/* What the follower asks for, in m/s² and rad/s. */
struct command {
    double acceleration, turn_rate;
};

/* Yours: numbers of type double, as many as are declared, and in that order. */
struct parameters;
struct memory;
struct shown;

/* JSON as it is, as a text. */
#define LAW_JSON(...) #__VA_ARGS__

/* Yours: the declaration, a text in JSON. */
LAW_EXPORT(declaration) const char *declaration(void);
/* Yours: the command of a sample; `memory` becomes that of the next sample. */
LAW_EXPORT(decide) void decide(const struct told *told, const struct parameters *own, struct memory *memory,
                               struct shown *shown, struct command *command);
/* Yours, if the memory does not start at 0. */
LAW_EXPORT(start) void start(const struct told *told, const struct parameters *own, struct memory *memory);
/* Yours, if the law acts in continuous time: the command of an instant, and the time derivatives of the memory. */
LAW_EXPORT(derive) void derive(const struct told *told, const struct parameters *own, const struct memory *memory,
                               struct memory *rates, struct command *command);

/* Room through which the numbers go in and out. */
LAW_EXPORT(region) double *region(void);
double *region(void) {
    static double room[1024];
    return room;
}

/* Elementary functions of the program, the same on every machine. */
LAW_IMPORT(sin) double sin(double x);
LAW_IMPORT(cos) double cos(double x);
LAW_IMPORT(tan) double tan(double x);
LAW_IMPORT(asin) double asin(double x);
LAW_IMPORT(acos) double acos(double x);
LAW_IMPORT(atan) double atan(double x);
LAW_IMPORT(atan2) double atan2(double y, double x);
LAW_IMPORT(exp) double exp(double x);
LAW_IMPORT(ln) double ln(double x);
LAW_IMPORT(tanh) double tanh(double x);
LAW_IMPORT(pow) double pow(double x, double y);
LAW_IMPORT(sqrt) double sqrt(double x);
LAW_IMPORT(floor) double floor(double x);
LAW_IMPORT(hypot) double hypot(double x, double y);
/* An angle brought into (−π, π]. */
LAW_IMPORT(wrap) double wrap(double angle);
/* Normally distributed, mean 0, variance 1; another for each index, sample and robot. */
LAW_IMPORT(noise) double noise(unsigned index);

#endif
