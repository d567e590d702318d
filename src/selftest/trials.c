/* The small jobs. Their numbers were recorded on llvmpipe (LLVM 15.0.6, 256 bits), Mesa 22.3.6. After a change of a model's numbers, record them
 * again from `hoodoo selftest --json`. */
#include "selftest/selftest.h"

static const char *const arenite[] = {
    "hoodoo: 1\n"
    "name: arenite\n"
    "frames: 1001-1007\n"
    "clock: {years_per_frame: 900}\n"
    "seed: 3\n"
    "domain: {size_m: [16, 10, 12], spacing_m: 0.5}\n"
    "rock: {interlock_band: 0.5}\n"
    "scene:\n"
    "  union:\n"
    "    - box: {min_m: [1, 1, 0], max_m: [15, 9, 1.5]}\n"
    "    - box: {min_m: [2, 2, 4], max_m: [14, 8, 10]}\n"
    "    - box: {min_m: [2, 2, 1], max_m: [5, 8, 5], inert: true}\n"
    "    - box: {min_m: [11, 2, 1], max_m: [14, 8, 5], inert: true}\n"
    "strata:\n"
    "  - {to_m: 6, weak_m_per_kyr: 0.2, strong_m_per_kyr: 0.02, interlock_MPa: 0.2}\n"
    "  - {weak_m_per_kyr: 0.05, strong_m_per_kyr: 0.01, interlock_MPa: 0.2}\n"
    "noise: {amplitude: 0.4, scale_m: 4}\n"
    "wind: {direction: [0.8, 0.6, 0], speed_m_s: {1001: 9, 1007: 12}, abrasion: 0.55, flow: {solver: sph, "
    "spacing_m: 2}}\n"
    "rain: {m_per_yr: 0.4, erosion: 2, threshold_Pa: 0.1}\n"
    "deposition: {viability: 0.3, repose_deg: 34}\n"
    "skin: {exposed: true}\n",
    NULL};

static const char *const collapse[] = {"hoodoo: 1\n"
                                       "name: collapse\n"
                                       "frames: 1001-1003\n"
                                       "clock: {seconds_per_frame: 0.0625}\n"
                                       "seed: 3\n"
                                       "domain: {size_m: [12, 6, 8.4], spacing_m: 0.3}\n"
                                       "scene:\n"
                                       "  union:\n"
                                       "    - box: {min_m: [1, 2, 0], max_m: [3, 4, 6]}\n"
                                       "    - box: {min_m: [3, 2, 4.5], max_m: [9, 4, 6]}\n"
                                       "    - box: {min_m: [9.5, 2, 0.5], max_m: [11, 4, 2]}\n"
                                       "collapse: {strength_MPa: 1, joints_m: 2, joint_strength: 0.002}\n",
                                       NULL};

/* Processes that the first job lacks, rock without particles deep inside, and the Jacobi preconditioner. */
static const char *const slow[] = {
    "hoodoo: 1\n"
    "name: slow\n"
    "frames: 1001-1003\n"
    "clock: {years_per_frame: 200}\n"
    "seed: 3\n"
    "domain: {size_m: [30, 24, 26], spacing_m: 1, sides: {x_min: wall}}\n"
    "scene:\n"
    "  union:\n"
    "    - box: {min_m: [-1, -1, 0], max_m: [31, 25, 4]}\n"
    "    - box: {min_m: [-1, 2, 4], max_m: [20, 22, 25]}\n"
    "    - box: {min_m: [20, 5, 18], max_m: [25, 19, 24]}\n"
    "    - box: {min_m: [20, 9, 15], max_m: [27, 15, 18]}\n"
    "paint: [{shape: {box: {min_m: [22, 0, 2], max_m: [30, 24, 6]}}, vegetation: 0.8}]\n"
    "strata:\n"
    "  - {to_m: 5, conductivity_m_per_yr: 0.001}\n"
    "  - {to_m: 14, weak_m_per_kyr: 0.5, strong_m_per_kyr: 0.05, interlock_MPa: 0.2}\n"
    "  - {weak_m_per_kyr: 0.3, interlock_MPa: 0.1}\n"
    "strata_from: [{from_m: 14, thickness_m: 0.3, thickness_spread: 0.5, hardness_spread: 0.25}]\n"
    "attitude: {dip_deg: 4, dip_azimuth_deg: 20}\n"
    "noise: {amplitude: 0.4, scale_m: 5}\n"
    "wind: {direction: [-0.8, 0.6, 0], speed_m_s: 9, abrasion: 0.5}\n"
    "rain: {m_per_yr: 0.3, erosion: 1}\n"
    "sources: [{path_m: [[2, 12, 25], [19, 12, 25]], m3_per_yr: 4000}]\n"
    "groundwater: {recharge_m_per_yr: 0.04, sapping: 4, weakening: 0.4}\n"
    "sheeting: {per_kyr: 2, thick_m: 0.5, strength_MPa: 0.002}\n"
    "skin: {crust: 5, crust_kyr: 2, depth_m: 0.7, before_kyr: 2, damp: 2, damp_m: 3}\n"
    "aspect: {azimuth_deg: 0, rate: 2, rate_per_100m: 1.5}\n"
    "deposition: {viability: 0.4, repose_deg: 34}\n"
    "vegetation: {growth_per_kyr: 3, spread_m_per_kyr: 5}\n"
    "stress: {solver: pcg, tolerance: 0.05}\n",
    NULL};

/* Blocks that fall within a frame, and stress by elastic waves. */
static const char *const fall[] = {
    "hoodoo: 1\n"
    "name: fall\n"
    "frames: 1001-1003\n"
    "clock: {years_per_frame: 900}\n"
    "seed: 3\n"
    "domain: {size_m: [12, 8, 9], spacing_m: 0.5, sides: {y_min: wall}}\n"
    "scene:\n"
    "  union:\n"
    "    - box: {min_m: [1, 1, 0], max_m: [10, 7, 3]}\n"
    "    - box: {min_m: [3, 3, 5], max_m: [6, 6, 7]}\n"
    "strata: [{weak_m_per_kyr: 0.2, strong_m_per_kyr: 0.02, interlock_MPa: 0.2}]\n"
    "noise: {amplitude: 0.4, scale_m: 4}\n"
    "wind: {direction: [0.8, 0.6, 0], speed_m_s: 9, abrasion: 0.5}\n"
    "deposition: {viability: 0.3}\n"
    "collapse: {blocks: fall, joints_m: 2}\n"
    "stress: {solver: mpm, tolerance: 0.05}\n",
    NULL};

static const char *const goblins[] = {
    "hoodoo: 1\n"
    "name: goblins\n"
    "model: goblins\n"
    "frames: 1001-1007\n"
    "clock: {years_per_frame: 300}\n"
    "domain: {size_m: [4, 4, 5], spacing_m: 0.1, sides: {x_min: wall}}\n"
    "scene: {cylinder: {from_m: [0.5, 2, 0], to_m: [0.5, 2, 4.5], radius_m: 1.5}}\n"
    "strata:\n"
    "  - {to_m: 2.5, weak_m_per_kyr: 0.2, bubble: {radius_m: 0.4}}\n"
    "  - {weak_m_per_kyr: 0.04, bubble: {shape: gumdrop, radius_m: 0.5, offset: [0.2, 0, 0.1]}}\n"
    "noise: {amplitude: 0.3, scale_m: 1}\n"
    "goblins: {stress: true, threshold: 0.5}\n",
    NULL};

static const char *const arches[] = {
    "hoodoo: 1\n"
    "name: arches\n"
    "model: arches\n"
    "frames: 1001-1007\n"
    "domain: {size_m: [16, 12, 10], spacing_m: 0.5}\n"
    "scene: {box: {min_m: [0, 0, 0], max_m: [16, 12, 7]}}\n"
    "arches:\n"
    "  sweeps: 4\n"
    "  operations:\n"
    "    - {tool: noise, frames: 1001, strength: 0.8, scale_m: 4}\n"
    "    - {tool: sweep, frames: 1001-1004, points_m: [[-1, 6, 4, 2], [8, 5, 4, 2.5], [17, 7, 4, 2]], roughness: 0.2}\n"
    "    - {tool: erode, frames: 1002-1006, points_m: [[4, 6, 6, 2], [11, 6, 6, 2]], rocks: 0.7}\n"
    "    - {tool: fill, frames: 1005, points_m: [[8, 6, 4, 1]], level_m: 2.5}\n",
    NULL};

const struct trial trials[] = {
    {"arenite",
     arenite,
     {.ledger = {.start = 5520},
      .volume_m3 = 545.012666,
      .lost_m3 = 144.987,
      .height_m = 4.701709,
      .stress_p95_Pa = 289077}},
    {"arenite in seconds",
     collapse,
     {.ledger = {.start = 2208},
      .volume_m3 = 46.4357812,
      .lost_m3 = 0,
      .height_m = 3.537048,
      .stress_p95_Pa = 279256}},
    {"arenite, slow",
     slow,
     {.ledger = {.start = 11826},
      .volume_m3 = 11402.4816,
      .lost_m3 = 423.518,
      .height_m = 11.62596,
      .stress_p95_Pa = 708046}},
    {"arenite, blocks",
     fall,
     {.ledger = {.start = 1440},
      .volume_m3 = 130.812123,
      .lost_m3 = 49.1879,
      .height_m = 1.634996,
      .stress_p95_Pa = 93752.8}},
    {"goblins",
     goblins,
     {.ledger = {.start = 23760},
      .volume_m3 = 19.07863,
      .lost_m3 = 3.450198,
      .height_m = 2.340079,
      .stress_p95_Pa = 138602}},
    {"arches",
     arches,
     {.ledger = {.start = 144310900224},
      .volume_m3 = 1044.9602,
      .lost_m3 = 299.04,
      .height_m = 4.048444,
      .stress_p95_Pa = 0}},
};
const size_t n_trials = sizeof trials / sizeof *trials;
