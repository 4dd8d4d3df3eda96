// The modes in force, written as G-code. Context: main loop.
#include "gcode/gcode_interpreter.h"

static const char *motion_text(motion_t motion) {
    static const char *const texts[] = {
        [MOTION_NONE] = "G80",
        [MOTION_RAPID] = "G0",
        [MOTION_FEED] = "G1",
        [MOTION_ARC_CW] = "G2",
        [MOTION_ARC_CCW] = "G3",
        [MOTION_PROBE_TO] = "G38.2",
        [MOTION_PROBE_TO_MAYBE] = "G38.3",
        [MOTION_PROBE_OFF] = "G38.4",
        [MOTION_PROBE_OFF_MAYBE] = "G38.5",
        [MOTION_CYCLE_CHIPS] = "G73",
        [MOTION_CYCLE_DRILL] = "G81",
        [MOTION_CYCLE_DWELL] = "G82",
        [MOTION_CYCLE_PECK] = "G83",
    };
    return texts[motion];
}

static const char *path_text(stepper_corner_t corner) {
    return corner == STEPPER_CORNER_EXACT ? "G61" : corner == STEPPER_CORNER_STOP ? "G61.1" : "G64";
}

static const char *coolant_text(const modal_t *modal) {
    return modal->flood ? modal->mist ? "M7 M8" : "M8" : modal->mist ? "M7" : "M9";
}

size_t gcode_modes(char *text) {
    static const char *const systems[GCODE_SYSTEMS] = {"G54", "G55",   "G56",   "G57",  "G58",
                                                       "G59", "G59.1", "G59.2", "G59.3"};
    static const char *const spindles[] = {"M5", "M3", "M4"};
    const modal_t *modal = &gcode_live.state.modal;
    double feed = modal->inches ? modal->feed / GCODE_MM_PER_INCH : modal->feed;
    return format_text(
        text, GCODE_MODES_SIZE, "%s %s G%d %s %s %s %s G40 %s %s %s %s %s T%u F%.9g S%.9g",
        motion_text((motion_t)modal->motion), systems[modal->system], 17 + modal->plane,
        modal->inches ? "G20" : "G21", modal->relative ? "G91" : "G90",
        modal->centre_absolute ? "G90.1" : "G91.1", modal->inverse_time ? "G93" : "G94",
        modal->retract_to_r ? "G99" : "G98", path_text(modal->path.corner),
        modal->tool_length_mm != 0.0 ? "G43.1" : "G49", spindles[modal->spindle],
        coolant_text(modal), (unsigned)modal->tool, feed, modal->rpm);
}
