/* A small job of each model, with all its processes on, and a shot in real time. */
#ifndef HOODOO_TEST_SMALL_JOBS_H
#define HOODOO_TEST_SMALL_JOBS_H

static const char *const arenite =
    "hoodoo: 1\n"
    "name: all\n"
    "frames: 1001-1006\n"
    "clock: {years_per_frame: 1500}\n"
    "domain: {size_m: [16, 12, 12], spacing_m: 1}\n"
    "scene:\n"
    "  union:\n"
    "    - box: {min_m: [2, 2, 3], max_m: [14, 10, 10]}\n"
    "    - box: {min_m: [2, 2, 0], max_m: [5, 10, 3], inert: true}\n"
    "strata:\n"
    "  - {to_m: 6, weak_m_per_kyr: 0.3, strong_m_per_kyr: 0.02, interlock_MPa: 0.2}\n"
    "  - {weak_m_per_kyr: 0.1, strong_m_per_kyr: 0.01, interlock_MPa: 0.2}\n"
    "noise: {amplitude: 0.4, scale_m: 4}\n"
    "wind: {speed_m_s: 12, flow: {solver: sph, spacing_m: 4, flushes: 0.3}}\n"
    "rain: {m_per_yr: 0.4, threshold_Pa: 0.1}\n"
    "deposition: {viability: 0.5}\n"
    "vegetation: {growth_per_kyr: 1, spread_m_per_kyr: 2}\n"
    "collapse: {blocks: fall, longest_s: 0.3, rubble_m: 1, wave_m_s: 40}\n"
    "stress: {max_iterations: 200}\n";
static const char *const shot =
    "hoodoo: 1\n"
    "name: shot\n"
    "frames: 1001-1008\n"
    "clock: {seconds_per_frame: 0.0416667}\n"
    "domain: {size_m: [12, 6, 8.4], spacing_m: 0.6}\n"
    "scene:\n"
    "  union:\n"
    "    - box: {min_m: [1, 2, 0], max_m: [3, 4, 6]}\n"
    "    - box: {min_m: [3, 2, 4.5], max_m: [9, 4, 6]}\n"
    "collapse: {strength_MPa: 1, joints_m: 2.4, joint_strength: 0.002, wave_m_s: 60}\n";
static const char *const goblins =
    "hoodoo: 1\n"
    "name: goblin\n"
    "model: goblins\n"
    "frames: 1-8\n"
    "clock: {years_per_frame: 300}\n"
    "domain: {size_m: [4, 4, 5], spacing_m: 0.25}\n"
    "scene: {cylinder: {from_m: [2, 2, 0], to_m: [2, 2, 4.5], radius_m: 1.5}}\n"
    "strata: [{weak_m_per_kyr: 0.2, bubble: {radius_m: 0.5}}]\n"
    "noise: {amplitude: 0.3, scale_m: 1}\n";
static const char *const arches =
    "hoodoo: 1\n"
    "name: terrain\n"
    "model: arches\n"
    "frames: 1-8\n"
    "domain: {size_m: [16, 12, 10], spacing_m: 1}\n"
    "scene: {box: {min_m: [0, 0, 0], max_m: [16, 12, 7]}}\n"
    "arches:\n"
    "  sweeps: 4\n"
    "  stacks: all\n"
    "  operations:\n"
    "    - {tool: noise, frames: 1, strength: 0.8, scale_m: 4}\n"
    "    - {tool: sweep, frames: 1-4, points_m: [[-1, 6, 4, 2], [8, 5, 4, 2.5], [17, 7, 4, 2]]}\n"
    "    - {tool: erode, frames: 2-6, points_m: [[4, 6, 6, 2], [11, 6, 6, 2]], rocks: 0.7}\n";

#endif
