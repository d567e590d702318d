/* What is settled for whole boxes at once is what its points say one by one: on random scenes, whose faces lie as
 * often on voxels' faces as anywhere else. */
#include "scene_help.h"

enum { N = 12, SCENES = 40, MOST_NODES = 64 };
static const double H = 0.5;

struct pool {
    struct job_node node[MOST_NODES], *child[MOST_NODES];
    double path[MOST_NODES][3][3];
    size_t n_nodes, n_children, n_paths;
    uint32_t random;
};

static double between(struct pool *p, double low, double high)
{
    return low + (high - low) * (next_random(&p->random) % 4096 / 4096.0);
}

/* Within the domain and a little around it; every other one on a voxel's corner. */
static void random_point(struct pool *p, double x[3])
{
    const bool corner = next_random(&p->random) % 2;
    for (int a = 0; a < 3; a++) {
        x[a] = between(p, -1, N * H + 1);
        x[a] = corner ? round(x[a] / H) * H : x[a];
    }
}

static struct job_node random_box(struct pool *p)
{
    double a[3], b[3];
    struct job_node box = BOX(.min_m = {0, 0, 0});
    random_point(p, a);
    random_point(p, b);
    for (int k = 0; k < 3; k++) {
        box.u.box.min_m[k] = fmin(a[k], b[k]);
        box.u.box.max_m[k] = fmax(a[k], b[k]) + H;
    }
    if (next_random(&p->random) % 3 == 0) {
        box.u.box.scale[0] = between(p, 0.5, 1.5);
        box.u.box.translate_m[2] = between(p, -1, 1);
        for (int k = 0; k < 3; k++)
            box.u.box.rotate_deg[k] = 45 * (next_random(&p->random) % 3);
    }
    return box;
}

static struct job_node random_shape(struct pool *p)
{
    double a[3], b[3];
    random_point(p, a);
    random_point(p, b);
    switch (next_random(&p->random) % 8) {
    case 0:
        return SPHERE(.center_m = {a[0], a[1], a[2]}, .radius_m = between(p, 0.3, 3));
    case 1:
        return CYLINDER(.from_m = {a[0], a[1], a[2]}, .to_m = {b[0], b[1], b[2] + 0.1},
                        .radius_m = between(p, 0.3, 3), .top_radius_m = between(p, 0, 3));
    case 2:
        return PLANE(.point_m = {a[0], a[1], a[2]}, .normal = {between(p, -1, 1), 0, 1});
    case 3: {
        double(*path)[3] = p->path[p->n_paths++];
        memcpy(path[0], a, sizeof a);
        memcpy(path[1], b, sizeof b);
        return (struct job_node){
            .kind = NODE_SHAPE,
            .shape = SHAPE_STROKE,
            .u.stroke = {PLACED, .path_m = path, .n_path_m = 2, .radius_m = between(p, 0.3, 2)}};
    }
    default:
        return random_box(p);
    }
}

static struct job_node *random_tree(struct pool *p, int depth)
{
    struct job_node *node = &p->node[p->n_nodes++];
    if (depth == 0) {
        *node = random_shape(p);
        return node;
    }
    const size_t n = 2 + next_random(&p->random) % 2;
    static const enum job_node_kind kinds[] = {NODE_UNION, NODE_DIFFERENCE, NODE_INTERSECTION};
    *node = (struct job_node){.kind = kinds[next_random(&p->random) % 3],
                              .child = p->child + p->n_children,
                              .n_child = n,
                              .u.group = {PLACED}};
    p->n_children += n;
    for (size_t i = 0; i < n; i++)
        node->child[i] = random_tree(p, depth - 1);
    return node;
}

/* The share of a voxel, point by point. */
static unsigned points_in_rock(const struct solid *solid, int i, int j, int k)
{
    unsigned inside = 0;
    for (int p = 0; p < COVERAGE_FULL; p++) {
        const double x[3] = {(i + (p % COVERAGE_FULL + 0.5) / COVERAGE_FULL) * H,
                             (j + (p * 47 % COVERAGE_FULL + 0.5) / COVERAGE_FULL) * H,
                             (k + (p * 57 % COVERAGE_FULL + 0.5) / COVERAGE_FULL) * H};
        inside += solid_at(solid, x).distance <= 0;
    }
    return inside;
}

static unsigned share[N][N][N];

static bool is_bare(int i, int j, int k)
{
    static const int step[6][3] = {{-1, 0, 0}, {1, 0, 0}, {0, -1, 0}, {0, 1, 0}, {0, 0, -1}, {0, 0, 1}};
    for (int f = 0; f < 6; f++) {
        const int v[3] = {i + step[f][0], j + step[f][1], k + step[f][2]};
        if (v[2] < 0)
            continue;
        if (v[0] < 0 || v[1] < 0 || v[0] >= N || v[1] >= N || v[2] >= N || share[v[2]][v[1]][v[0]] == 0)
            return true;
    }
    return false;
}

/* Gives how many voxels hold rock, and how many of them are bare. */
static void look_at_every_point(const struct solid *solid, const struct coverage *coverage, size_t *rock,
                                size_t *bare)
{
    for (int v = 0; v < N * N * N; v++) {
        const int i = v % N, j = v / N % N, k = v / N / N;
        const unsigned n = points_in_rock(solid, i, j, k);
        share[k][j][i] = n;
        *rock += n > 0;
        assert_int_equal(coverage_at(coverage, i, j, k), n);
        assert_int_equal(coverage_of_voxel(solid, H, i, j, k), n);
        assert_int_equal(coverage_holds_rock(solid, H, i, j, k), n > 0);
        const double min[3] = {i * H, j * H, k * H}, max[3] = {(i + 1) * H, (j + 1) * H, (k + 1) * H};
        const enum solid_share said = solid_in_box(solid, min, max);
        assert_true(said == SOLID_SOME || n == (said == SOLID_ALL ? COVERAGE_FULL : 0));
    }
    for (int v = 0; v < N * N * N; v++)
        *bare += share[v / N / N][v / N % N][v % N] > 0 && is_bare(v % N, v / N % N, v / N / N);
}

static void boxes_hold_what_their_points_say(void **state)
{
    (void)state;
    const int size[3] = {N, N, N};
    size_t with_rock = 0;
    for (uint32_t scene = 1; scene <= SCENES; scene++) {
        struct pool pool = {.random = scene * 2654435761U};
        struct job job = cube_job(random_tree(&pool, (int)(scene % 4)), N, H);
        struct solid *solid;
        struct coverage *coverage;
        struct scene_size estimate;
        size_t rock = 0, bare = 0;
        assert_int_equal(solid_create(job.scene, H / 2, COVERAGE_REACH * H, &solid), OK);
        assert_int_equal(coverage_create(solid, size, H, &coverage), OK);
        look_at_every_point(solid, coverage, &rock, &bare);
        assert_int_equal(scene_estimate(&job, &estimate), OK);
        assert_int_equal(estimate.n_particles, rock);
        assert_int_equal(estimate.n_points, rock);
        assert_int_equal(estimate.n_surface, bare);
        with_rock += rock > 0;
        free(estimate.point);
        coverage_destroy(&coverage);
        solid_destroy(&solid);
    }
    assert_true(with_rock > SCENES / 2);
}

/* Of a block on two feet, whose faces are voxels' faces, no voxel is left to its points. */
static void faces_on_voxels_are_settled_by_boxes(void **state)
{
    (void)state;
    struct job_node top = BOX(.min_m = {1, 1, 3}, .max_m = {6, 6, 6}),
                    foot = BOX(.min_m = {1, 1, 0}, .max_m = {2, 6, 3}),
                    other = BOX(.min_m = {5, 1, 0}, .max_m = {6, 6, 3}),
                    scene = GROUP(NODE_UNION, &top, &foot, &other);
    struct solid *solid;
    assert_int_equal(solid_create(&scene, H / 2, H, &solid), OK);
    for (int v = 0; v < N * N * N; v++) {
        const double min[3] = {v % N * H, v / N % N * H, v / N / N * H},
                     max[3] = {min[0] + H, min[1] + H, min[2] + H};
        assert_int_equal(solid_in_box(solid, min, max),
                         points_in_rock(solid, v % N, v / N % N, v / N / N) > 0 ? SOLID_ALL : SOLID_NONE);
    }
    solid_destroy(&solid);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(boxes_hold_what_their_points_say),
        cmocka_unit_test(faces_on_voxels_are_settled_by_boxes),
    };
    cmocka_set_message_output(CM_OUTPUT_TAP);
    return cmocka_run_group_tests(tests, NULL, NULL);
}
