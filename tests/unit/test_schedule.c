/* Schedules on some nodes, against ones worked out by hand and against bounds that every schedule obeys. */
#include "check.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "base/random.h"
#include "effort.h"
#include "farm/cost.h"
#include "farm/schedule.h"

enum { MOST = 64 };

static uint32_t draw(void)
{
    static uint32_t n;
    return random_hash(n++, 3, 77, 1);
}

/* It failed as wrong usage, and says these words. */
static void assert_refused(status st, const char *words, const char *advice)
{
    assert_int_equal(st, E_USAGE);
    assert_non_null(strstr(status_message(), words));
    assert_non_null(strstr(status_message(), advice));
}

/* A graph written down: task i takes seconds[i] and waits for the tasks whose bits are set in after[i]. */
static struct farm_graph drawn(size_t n, const double *seconds, const uint64_t *after)
{
    struct farm_graph g = {.n = n};
    assert_ok(memory_alloc(n, sizeof *g.task, "tasks", &g.task));
    assert_ok(memory_alloc(n * n + 1, sizeof *g.after, "tasks", &g.after));
    for (size_t i = 0; i < n; i++) {
        g.task[i].kind = FARM_MESH;
        snprintf(g.task[i].name, sizeof g.task[i].name, "t%zu", i);
        g.task[i].seconds = seconds[i];
        g.task[i].after = g.n_after;
        for (size_t k = 0; k < i; k++)
            if (after[i] >> k & 1)
                g.after[g.n_after++] = k;
        g.task[i].n_after = g.n_after - g.task[i].after;
    }
    return g;
}

static void expect(const struct farm_graph *g, size_t nodes, double wall, double paid, size_t used)
{
    struct schedule s;
    assert_ok(schedule_make(g, nodes, &s));
    assert_true(fabs(s.seconds - wall) < 1e-9);
    assert_true(fabs(s.node_seconds - paid) < 1e-9);
    assert_int_equal(s.nodes_used, used);
    schedule_free(&s);
}

/* Two blocks of 10 s, one after the other; pictures of 4 s and 6 s of the first, of 4 s of the second; an end of 1 s behind all.
 *
 *   1 node    10 + 10 + 4 + 6 + 4 + 1 = 35
 *   2 nodes   block 1: 0-10; block 2: 10-20 | 6: 10-16, 4: 16-20; then 4: 20-24, end: 24-25. Node 2 is paid to 20.
 *   3 nodes   block 2: 10-20, 6: 10-16, 4: 10-14; then 4: 20-24 and the end 24-25, on node 1. Paid 25 + 16 + 14. */
static void blocks_and_pictures(void **state)
{
    (void)state;
    const double seconds[] = {10, 10, 4, 6, 4, 1};
    const uint64_t after[] = {0, 1, 1, 1, 2, 31};
    struct farm_graph g = drawn(6, seconds, after);
    size_t *path, n;
    double longest;
    expect(&g, 1, 35, 35, 1);
    expect(&g, 2, 25, 45, 2);
    expect(&g, 3, 25, 55, 3);
    expect(&g, 100, 25, 55, 3);
    assert_ok(schedule_critical_path(&g, &path, &n, &longest));
    const size_t wanted[] = {0, 1, 4, 5};
    assert_true(longest == 25 && n == 4 && memcmp(path, wanted, sizeof wanted) == 0);
    free(path);
    graph_free(&g);
}

/* Four wedges of three blocks of 5 s advance together: on two nodes each runs six blocks without a gap, 30 s. On three nodes the first nine
 * blocks take 15 s, and the last three, which are of one wedge or of several, at least 5 more. */
static void wedges_advance_together(void **state)
{
    (void)state;
    double seconds[12];
    uint64_t after[12] = {0};
    for (size_t i = 0; i < 12; i++) {
        seconds[i] = 5;
        after[i] = i % 3 ? (uint64_t)1 << (i - 1) : 0;
    }
    struct farm_graph g = drawn(12, seconds, after);
    size_t *order;
    const size_t wanted[12] = {0, 3, 6, 9, 1, 4, 7, 10, 2, 5, 8, 11};
    assert_ok(schedule_order(&g, &order));
    assert_memory_equal(order, wanted, sizeof wanted);
    free(order);
    expect(&g, 1, 60, 60, 1);
    expect(&g, 2, 30, 60, 2);
    expect(&g, 3, 20, 60, 3);
    expect(&g, 4, 15, 60, 4);
    graph_free(&g);
}

static bool overlap(double a, double a_end, double b, double b_end)
{
    return a < b_end && b < a_end;
}

/* Random graphs: no task before what it waits for, no two at once on a node, no node idle while a task is ready, and Graham's bound. */
static void schedules_are_possible_and_not_idle(void **state)
{
    (void)state;
    for (size_t trial = 0; trial < effort_of(300); trial++) {
        const size_t n = 1 + draw() % 40, nodes = 1 + draw() % 6;
        double seconds[MOST], work = 0, longest;
        uint64_t after[MOST];
        size_t *path, n_path;
        for (size_t i = 0; i < n; i++) {
            seconds[i] = (double)(draw() % 8);
            work += seconds[i];
            after[i] = draw() & draw() & draw() & (((uint64_t)1 << i) - 1);
        }
        struct farm_graph g = drawn(n, seconds, after);
        struct schedule s;
        assert_ok(schedule_make(&g, nodes, &s));
        assert_ok(schedule_critical_path(&g, &path, &n_path, &longest));
        for (size_t i = 0; i < n; i++) {
            double ready = 0;
            for (size_t k = 0; k < i; k++) {
                if (after[i] >> k & 1) {
                    assert_true(s.start[i] >= s.start[k] + seconds[k]);
                    ready = fmax(ready, s.start[k] + seconds[k]);
                }
                assert_false(s.node[i] == s.node[k] && overlap(s.start[i], s.start[i] + seconds[i],
                                                               s.start[k], s.start[k] + seconds[k]));
            }
            /* While it waited for a node, all of them worked. */
            for (double t = ready; t < s.start[i]; t++) {
                size_t busy = 0;
                for (size_t k = 0; k < n; k++)
                    busy += s.start[k] <= t && t < s.start[k] + seconds[k];
                assert_int_equal(busy, nodes < n ? nodes : n);
            }
        }
        assert_true(fabs(s.busy_seconds - work) < 1e-9 && s.node_seconds >= work - 1e-9);
        assert_true(s.seconds >= longest - 1e-9 && s.seconds >= work / (double)nodes - 1e-9);
        assert_true(s.seconds <= work / (double)nodes + longest + 1e-9);
        for (size_t i = 1; i < n_path; i++)
            assert_true(after[path[i]] >> path[i - 1] & 1);
        free(path);
        schedule_free(&s);
        graph_free(&g);
    }
}

static void prices_and_numbers_are_checked(void **state)
{
    (void)state;
    struct cost_asked asked;
    assert_ok(cost_parse("1,4,16", "2.5/h", &asked));
    assert_true(asked.n == 3 && asked.nodes[2] == 16 && asked.price_h == 2.5);
    assert_ok(cost_parse("7", NULL, &asked));
    assert_true(asked.n == 1 && asked.price_h < 0);
    static const char *const bad[] = {
        "", "0", "1,", ",1", "1;2", "-3", "1,x", "100001", "99999999999999999999"};
    for (size_t i = 0; i < sizeof bad / sizeof *bad; i++)
        assert_refused(cost_parse(bad[i], NULL, &asked), "--nodes", "such as 1,4,16");
    static const char *const prices[] = {"", "x", "-1/h", "2/min", "nan/h", "inf", "2.5/h "};
    for (size_t i = 0; i < sizeof prices / sizeof *prices; i++)
        assert_refused(cost_parse("1", prices[i], &asked), "--price", "2.5/h");
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(blocks_and_pictures),
                                       cmocka_unit_test(wedges_advance_together),
                                       cmocka_unit_test(schedules_are_possible_and_not_idle),
                                       cmocka_unit_test(prices_and_numbers_are_checked)};
    return cmocka_run_group_tests_name("schedule", tests, NULL, NULL);
}
