#include "shape/function_make.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <cstring>
#include <exception>
#include <limits>
#include <memory>
#include <new>
#include <thread>
#include <vector>

#include <muParser.h>

namespace
{
struct caller {
    formula_noise *noise;
    const void *context;
};

double call_noise(void *data, double x, double y, double z)
{
    const caller *c = static_cast<const caller *>(data);
    const double at[3] = {x, y, z};
    return c->noise(c->context, at);
}

/* An evaluator with its own variables, for one thread at a time. */
struct evaluator {
    mu::Parser parser;
    std::array<double, 3> x{};
    std::atomic_flag used = ATOMIC_FLAG_INIT;

    evaluator(const char *expression, caller *noise)
    {
        parser.DefineVar("x", &x[0]);
        parser.DefineVar("y", &x[1]);
        parser.DefineVar("z", &x[2]);
        parser.DefineConst("pi", 3.14159265358979323846);
        parser.DefineFunUserData("noise", call_noise, noise, true);
        parser.SetExpr(expression);
        parser.Eval();
    }
};
} // namespace

struct formula {
    caller noise;
    std::vector<std::unique_ptr<evaluator>> one;
};

extern "C" status formula_make(const char *expression, formula_noise *noise, const void *context,
                               struct formula **out)
{
    try {
        auto made = std::make_unique<formula>();
        made->noise = {noise, context};
        const unsigned cores = std::max(1u, std::thread::hardware_concurrency());
        for (unsigned i = 0; i < cores; i++)
            made->one.push_back(std::make_unique<evaluator>(expression, &made->noise));
        *out = made.release();
        return OK;
    } catch (const mu::Parser::exception_type &e) {
        return fail(E_USAGE, "expression \"%.300s\": at character %d: %.300s", expression,
                    int(std::min(size_t(e.GetPos()), std::strlen(expression))) + 1, e.GetMsg().c_str());
    } catch (const std::bad_alloc &) {
        return fail(E_MEMORY, "out of memory: an expression");
    } catch (const std::exception &e) {
        return fail(E_USAGE, "expression \"%.300s\": %.300s", expression, e.what());
    }
}

extern "C" void formula_destroy(struct formula **f)
{
    delete *f;
    *f = nullptr;
}

extern "C" double formula_at(const struct formula *f, const double x[3])
{
    for (size_t i = 0;; i = (i + 1) % f->one.size()) {
        evaluator &e = *f->one[i];
        if (e.used.test_and_set(std::memory_order_acquire))
            continue;
        double value;
        try {
            e.x = {x[0], x[1], x[2]};
            value = e.parser.Eval();
        } catch (...) {
            value = std::numeric_limits<double>::quiet_NaN();
        }
        e.used.clear(std::memory_order_release);
        return value;
    }
}
