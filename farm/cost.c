#include "farm/cost.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "farm/schedule.h"

status cost_parse(const char *nodes, const char *price, struct cost_asked *out)
{
    char *end;
    *out = (struct cost_asked){.price_h = -1};
    for (const char *s = nodes;; s = end + 1) {
        const long n = *s >= '0' && *s <= '9' ? strtol(s, &end, 10) : 0;
        if (n < 1 || n > COST_NODES || (*end && *end != ',') || out->n == COST_ROWS)
            return fail(
                E_USAGE,
                "--nodes %.80s: write up to %d numbers of 1 to %d with commas between, such as 1,4,16", nodes,
                COST_ROWS, COST_NODES);
        out->nodes[out->n++] = (size_t)n;
        if (!*end)
            break;
    }
    if (!price)
        return OK;
    out->price_h = strtod(price, &end);
    if (end == price || (strcmp(end, "/h") != 0 && *end) || !(out->price_h >= 0 && out->price_h < 1e9))
        return fail(E_USAGE, "--price %.80s: write the price of a node for an hour, such as 2.5/h", price);
    return OK;
}

static double thousandths(double v)
{
    return round(1000 * v) / 1000;
}

static status put_rows(const struct farm_graph *g, const struct cost_asked *asked, struct text *out)
{
    status st = OK;
    json_array(out, "nodes");
    for (size_t i = 0; i < asked->n; i++) {
        struct schedule s;
        TRY(schedule_make(g, asked->nodes[i], &s));
        json_object(out, NULL);
        json_integer(out, "nodes", (int64_t)asked->nodes[i]);
        json_integer(out, "used", (int64_t)s.nodes_used);
        json_number(out, "wall_seconds", ceil(s.seconds));
        json_number(out, "node_hours", thousandths(s.node_seconds / 3600));
        json_integer(out, "busy_percent",
                     s.node_seconds > 0 ? (int64_t)round(100 * s.busy_seconds / s.node_seconds) : 100);
        if (asked->price_h >= 0)
            json_number(out, "cost", thousandths(asked->price_h * s.node_seconds / 3600));
        json_end_object(out);
        schedule_free(&s);
    }
    json_end_array(out);
done:
    return st;
}

/* "sim.1001-1050 and 3 more sim, sheet, turntable, end": runs of a kind are joined. */
static void put_chain(const struct farm_graph *g, const size_t *path, size_t n, struct text *out)
{
    struct text t = {0};
    for (size_t i = 0; i < n;) {
        size_t end = i + 1;
        while (end < n && g->task[path[end]].kind == g->task[path[i]].kind)
            end++;
        text_add(&t, "%s%s", i ? ", " : "", g->task[path[i]].name);
        if (end - i > 1)
            text_add(&t, " and %zu more", end - i - 1);
        i = end;
    }
    json_text(out, "critical_path", t.data ? t.data : "");
    out->failed |= t.failed;
    text_free(&t);
}

status cost_describe(const struct farm_graph *g, const struct cost_asked *asked, bool words, struct text *out)
{
    status st = OK;
    size_t *path = NULL, n = 0;
    double seconds;
    for (size_t i = 0; i < g->n; i++)
        if (g->task[i].kind == FARM_SIM && !(g->task[i].seconds > 0))
            return fail(
                E_USAGE,
                "--nodes: the time of a frame is not known; allow --rehearse on a device, or plan into a folder with frames");
    TRY(put_rows(g, asked, out));
    TRY(schedule_critical_path(g, &path, &n, &seconds));
    json_number(out, "shortest_seconds", ceil(seconds));
    if (words) {
        put_chain(g, path, n, out);
    } else {
        json_array(out, "critical_path");
        for (size_t i = 0; i < n; i++)
            json_text(out, NULL, g->task[path[i]].name);
        json_end_array(out);
    }
done:
    free(path);
    return st;
}
