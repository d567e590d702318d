/* Particles as an OpenVDB PointDataGrid. They are sorted into voxels, and by id within each voxel, so that the order in the file does not
 * depend on the order of the particles.
 *
 * With 16 bits, a position is rounded to the nearest of 65,536 along each side of its voxel. Shares (BITS_SHARE of values.def) are
 * rounded to the nearest of 65,536 from 0 to 1, where 0 and 1 are exact and nothing else becomes 0. v and Cd are halves. Normals are
 * unit vectors in two bytes if every particle of the leaf has one, otherwise halves, because OpenVDB's unit vectors cannot be zero.
 * Stresses, rates and integers are exact. */
#include "vdb/shim.hpp"

#include <openvdb/points/AttributeArray.h>
#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <unordered_map>
#include <vector>

namespace
{
using openvdb::Coord;
using openvdb::Index;
using openvdb::Vec3d;
using openvdb::Vec3f;
using openvdb::points::AttributeSet;
using openvdb::points::PointDataGrid;
using quaternion = openvdb::math::Quat<float>; /* x, y, z, w */
using leaf_node = openvdb::points::PointDataTree::LeafNodeType;
using descriptor = AttributeSet::Descriptor;

/* How a value is stored. */
enum coding { EXACT, HALF, SHARE, DIRECTION, PLACE };
using exact = openvdb::points::NullCodec;
using half = openvdb::points::TruncateCodec;
using share = openvdb::points::FixedPointCodec<false, openvdb::points::UnitRange>;
using direction = openvdb::points::UnitVecCodec;
using place = openvdb::points::FixedPointCodec<false, openvdb::points::PositionRange>;
template <class T, class codec> using array_of = openvdb::points::TypedAttributeArray<T, codec>;
constexpr double STEPS = 65535;

/* The codecs truncate to a step, so values are first moved to the middle of the nearest step. */
float nearest_step(double x)
{
    return float((std::floor(x * STEPS + 0.5) + 0.5) / STEPS);
}
float nearest_share(float x)
{
    return x > 0 && x < float(1 / STEPS) ? float(1.5 / STEPS) : nearest_step(double(x));
}

/* The particles of each leaf: those of leaf l are particle[begin[l]] to particle[begin[l + 1] - 1], ascending. */
struct leaf_lists {
    std::vector<Coord> origin;
    std::vector<uint32_t> begin, particle;
};

struct placement {
    const float *P;
    double voxel;
    bool y_up;
    Vec3d index(size_t i) const
    {
        return vdb::file_from_sim(Vec3d(P[4 * i], P[4 * i + 1], P[4 * i + 2]), y_up) / voxel;
    }
};

struct hash_coord {
    size_t operator()(const Coord &c) const
    {
        return c.hash<20>();
    }
};

bool is_written(const rock &r, const vdb_options &options, size_t i)
{
    if (options.points == VDB_POINTS_ALL || !r.N)
        return options.points != VDB_POINTS_NONE;
    const float *n = r.N + 4 * i;
    return options.points == VDB_POINTS_SURFACE && (n[0] != 0 || n[1] != 0 || n[2] != 0);
}

/* Returns false if the position of a particle is not finite; `bad` is its index. */
bool sort_into_leaves(const rock &r, const vdb_options &options, const placement &at, leaf_lists &lists,
                      size_t &bad)
{
    constexpr uint32_t NOT_WRITTEN = UINT32_MAX;
    constexpr double FAR = 1 << 30;
    std::unordered_map<Coord, uint32_t, hash_coord> known;
    std::vector<uint32_t> leaf_of(r.n), count;
    Coord last_origin = Coord::max();
    uint32_t last = NOT_WRITTEN;
    for (size_t i = 0; i < r.n; i++) {
        leaf_of[i] = NOT_WRITTEN;
        if (!is_written(r, options, i))
            continue;
        const Vec3d x = at.index(i);
        if (!(std::fabs(x[0]) < FAR && std::fabs(x[1]) < FAR && std::fabs(x[2]) < FAR)) {
            bad = i;
            return false;
        }
        const Coord origin = Coord::round(x) & ~int(leaf_node::DIM - 1);
        if (origin != last_origin) {
            const auto found = known.try_emplace(origin, uint32_t(lists.origin.size()));
            if (found.second) {
                lists.origin.push_back(origin);
                count.push_back(0);
            }
            last_origin = origin;
            last = found.first->second;
        }
        leaf_of[i] = last;
        count[last]++;
    }
    lists.begin.assign(count.size() + 1, 0);
    for (size_t l = 0; l < count.size(); l++)
        lists.begin[l + 1] = lists.begin[l] + count[l];
    lists.particle.resize(lists.begin.back());
    std::vector<uint32_t> next(lists.begin.begin(), lists.begin.end() - 1);
    for (size_t i = 0; i < r.n; i++)
        if (leaf_of[i] != NOT_WRITTEN)
            lists.particle[next[leaf_of[i]]++] = uint32_t(i);
    return true;
}

/* An attribute of the file, and how its value for particle i is made. Values that are equal within a leaf are stored once. */
enum attribute_kind { CONSTANT, FLOAT, INT, VECTOR, COLOR, ORIENT };
struct attribute {
    std::string name;
    attribute_kind kind;
    const void *from;
    coding how = EXACT;
};

template <class T, class codec = exact, class value_fn>
void fill(openvdb::points::AttributeArray &array, const std::vector<uint32_t> &order, const value_fn &value)
{
    const T first = value(order[0]);
    size_t k = 1;
    while (k < order.size() && value(order[k]) == first)
        k++;
    if (k == order.size()) {
        array_of<T, codec>::collapse(&array, first);
        return;
    }
    openvdb::points::AttributeWriteHandle<T, codec> handle(array, /*expand=*/true);
    for (k = 0; k < order.size(); k++)
        handle.set(Index(k), value(order[k]));
}

class leaf_maker
{
  public:
    leaf_maker(const rock &r, const vdb_options &options, const placement &at)
        : at_(at), options_(options), layer_(r.layer), id_(r.id)
    {
        pscale_ = options.instances ? 1 : float(options.spacing / 2);
        attributes_.push_back({"pscale", CONSTANT, &pscale_});
        attributes_.push_back({"v", r.v ? VECTOR : CONSTANT, r.v});
        if (options.instances) {
            attributes_.push_back({"orient", ORIENT, nullptr});
            attributes_.push_back({"variant", INT, layer_});
        }
        if (layer_ && options.color && options.n_colors && !options.instances)
            attributes_.push_back({"Cd", COLOR, nullptr});
        for (int f = 0; f < ROCK_FIELDS; f++) {
            const rock_field_info &info = rock_field_table[f];
            if (f != ROCK_P && f != ROCK_v && *info.vdb && r.field[f])
                attributes_.push_back({info.vdb,
                                       info.components == 4 ? VECTOR
                                       : info.is_float      ? FLOAT
                                                            : INT,
                                       r.field[f]});
        }
        if (options.precision == VDB_PRECISION_16_BIT)
            for (attribute &a : attributes_)
                a.how = coding_of(a.name);
        position_ = descriptor::create(options.precision == VDB_PRECISION_16_BIT
                                           ? array_of<Vec3f, place>::attributeType()
                                           : array_of<Vec3f, exact>::attributeType());
        all_ = position_;
        for (const attribute &a : attributes_)
            all_ = all_->duplicateAppend(a.name, type_of(a));
    }

    leaf_node *make(const Coord &origin, const uint32_t *particle, size_t n) const
    {
        /* by voxel; within a voxel by id */
        std::vector<uint32_t> by_id(particle, particle + n);
        if (id_)
            std::sort(by_id.begin(), by_id.end(), [this](uint32_t a, uint32_t b) { return id_[a] < id_[b]; });
        uint32_t end[leaf_node::SIZE] = {0};
        std::vector<uint16_t> voxel(n);
        for (size_t k = 0; k < n; k++) {
            voxel[k] = uint16_t(leaf_node::coordToOffset(Coord::round(at_.index(by_id[k]))));
            end[voxel[k]]++;
        }
        std::vector<leaf_node::ValueType> offsets(leaf_node::SIZE);
        uint32_t sum = 0;
        for (size_t v = 0; v < leaf_node::SIZE; v++) {
            const uint32_t start = sum;
            sum += end[v];
            offsets[v] = leaf_node::ValueType(sum);
            end[v] = start;
        }
        std::vector<uint32_t> order(n);
        for (size_t k = 0; k < n; k++)
            order[end[voxel[k]]++] = by_id[k];

        std::unique_ptr<leaf_node> leaf(new leaf_node(origin));
        leaf->initializeAttributes(position_, Index(n));
        leaf->replaceAttributeSet(new AttributeSet(all_, Index(n)), /*allowMismatchingDescriptors=*/true);
        leaf->setOffsets(offsets);
        const auto local = [this](uint32_t i) {
            const Vec3d x = at_.index(i);
            return x - Coord::round(x).asVec3d();
        };
        if (options_.precision == VDB_PRECISION_16_BIT)
            fill<Vec3f, place>(leaf->attributeArray(0), order, [&local](uint32_t i) {
                const Vec3d x = local(i) + 0.5;
                return Vec3f(nearest_step(x[0]) - 0.5F, nearest_step(x[1]) - 0.5F, nearest_step(x[2]) - 0.5F);
            });
        else
            fill<Vec3f>(leaf->attributeArray(0), order, [&local](uint32_t i) { return Vec3f(local(i)); });
        for (size_t a = 0; a < attributes_.size(); a++)
            fill_attribute(leaf->attributeArray(a + 1), attributes_[a], order);
        return leaf.release();
    }

  private:
    /* The coding with 16 bits, from values.def; colours are halves. */
    coding coding_of(const std::string &name) const
    {
        for (int v = 1; v < VALUES; v++)
            if (value_field[v] >= 0 && name == rock_field_table[value_field[v]].vdb)
                switch (value_table[v].bits) {
                case BITS_SHARE:
                    return SHARE;
                case BITS_HALF:
                    return HALF;
                case BITS_DIRECTION:
                    return options_.points == VDB_POINTS_SURFACE ? DIRECTION : HALF;
                case BITS_EXACT:
                    return EXACT;
                }
        return name == "Cd" ? HALF : EXACT;
    }

    openvdb::NamePair type_of(const attribute &a) const
    {
        if (a.kind == ORIENT)
            return array_of<quaternion, exact>::attributeType();
        if (a.kind == INT)
            return array_of<int32_t, exact>::attributeType();
        if (a.kind == FLOAT || a.from == &pscale_)
            return a.how == SHARE  ? array_of<float, share>::attributeType()
                   : a.how == HALF ? array_of<float, half>::attributeType()
                                   : array_of<float, exact>::attributeType();
        return a.how == HALF        ? array_of<Vec3f, half>::attributeType()
               : a.how == DIRECTION ? array_of<Vec3f, direction>::attributeType()
                                    : array_of<Vec3f, exact>::attributeType();
    }

    template <class value_fn>
    static void fill_vectors(openvdb::points::AttributeArray &array, const attribute &a,
                             const std::vector<uint32_t> &order, const value_fn &value)
    {
        if (a.how == HALF)
            fill<Vec3f, half>(array, order, value);
        else if (a.how == DIRECTION)
            fill<Vec3f, direction>(array, order, value);
        else
            fill<Vec3f>(array, order, value);
    }

    void fill_attribute(openvdb::points::AttributeArray &array, const attribute &a,
                        const std::vector<uint32_t> &order) const
    {
        const float *real = static_cast<const float *>(a.from);
        const uint32_t *whole = static_cast<const uint32_t *>(a.from);
        switch (a.kind) {
        case CONSTANT:
            if (real)
                openvdb::points::TypedAttributeArray<float>::collapse(&array, *real);
            break; /* otherwise it keeps its zeros */
        case FLOAT:
            if (a.how == SHARE)
                fill<float, share>(array, order, [real](uint32_t i) { return nearest_share(real[i]); });
            else if (a.how == HALF)
                fill<float, half>(array, order, [real](uint32_t i) { return real[i]; });
            else
                fill<float>(array, order, [real](uint32_t i) { return real[i]; });
            break;
        case INT:
            fill<int32_t>(array, order, [whole](uint32_t i) { return int32_t(whole[i]); });
            break;
        case VECTOR:
            fill_vectors(array, a, order, [real, this](uint32_t i) {
                return vdb::file_from_sim(Vec3f(real[4 * i], real[4 * i + 1], real[4 * i + 2]), at_.y_up);
            });
            break;
        case ORIENT:
            openvdb::points::TypedAttributeArray<quaternion>::collapse(&array, quaternion(0, 0, 0, 1));
            break;
        case COLOR:
            fill_vectors(array, a, order, [this](uint32_t i) {
                const size_t layer = layer_[i] < options_.n_colors ? layer_[i] : options_.n_colors - 1;
                return Vec3f(options_.color[layer]);
            });
        }
    }

    const placement &at_;
    const vdb_options &options_;
    const uint32_t *layer_, *id_;
    float pscale_;
    std::vector<attribute> attributes_;
    descriptor::Ptr position_, all_;
};
/* A piece of a frame's rock while its grid is made; throws refused if it cannot be made. */
class piece
{
  public:
    piece(const vdb_pieces &all, size_t i) : all_(all)
    {
        const status st = all.get(all.user, i, &rock_);
        if (st != OK)
            throw vdb::refused{st};
    }
    piece(const piece &) = delete;
    piece &operator=(const piece &) = delete;
    ~piece()
    {
        all_.drop(all_.user, &rock_);
    }
    const rock &get() const
    {
        return rock_;
    }

  private:
    const vdb_pieces &all_;
    rock rock_{};
};

/* Makes the grid of a piece. */
PointDataGrid::Ptr make_grid(const rock &r, const vdb_options &options)
{
    /* About eight particles per voxel, as OpenVDB recommends. */
    const placement at{r.P, 2 * options.spacing, options.up == OUTPUT_UP_Y};
    leaf_lists lists;
    size_t bad = 0;
    if (!sort_into_leaves(r, options, at, lists, bad))
        throw vdb::refused{fail(E_NUMERIC, "points of frame %d: particle %zu is at (%g, %g, %g) m",
                                options.frame, bad, double(r.P[4 * bad]), double(r.P[4 * bad + 1]),
                                double(r.P[4 * bad + 2]))};
    const leaf_maker maker(r, options, at);
    std::vector<std::unique_ptr<leaf_node>> leaves(lists.origin.size());
    tbb::parallel_for(
        tbb::blocked_range<size_t>(0, leaves.size()), [&](const tbb::blocked_range<size_t> &range) {
            for (size_t l = range.begin(); l < range.end(); l++)
                leaves[l].reset(maker.make(lists.origin[l], lists.particle.data() + lists.begin[l],
                                           lists.begin[l + 1] - lists.begin[l]));
        });
    auto grid = PointDataGrid::create();
    for (auto &leaf : leaves)
        grid->tree().addLeaf(leaf.release());
    grid->setTransform(openvdb::math::Transform::createLinearTransform(at.voxel));
    return grid;
}
} // namespace

extern "C" status vdb_encode_points(const struct vdb_pieces *pieces, const struct vdb_options *options,
                                    struct draft *out)
try {
    vdb::start();
    const rock &whole = *pieces->rock;
    if (!(options->spacing > 0) || !std::isfinite(options->spacing))
        return fail(E_OUTPUT, "points of frame %d: the spacing must not be %g m", options->frame,
                    options->spacing);
    if (whole.n >= UINT32_MAX || (whole.n && !whole.P))
        return fail(E_OUTPUT, "points of frame %d: %zu particles%s", options->frame, whole.n,
                    whole.P ? ", more than a file can number" : " without positions");
    const openvdb::MetaMap metadata = vdb::file_metadata(*options, 2 * options->spacing);
    const auto make = [&](size_t i) {
        const piece part(*pieces, i);
        const PointDataGrid::Ptr grid = make_grid(part.get(), *options);
        grid->setName(i == 0 ? "points" : "points_" + std::to_string(i + 1));
        grid->setCreator(metadata.metaValue<std::string>("creator"));
        return grid;
    };
    vdb::encode(pieces->n, make, *options, metadata, out);
    return OK;
} catch (const vdb::refused &r) {
    return r.st;
}
SHIM_CATCH(E_OUTPUT, "points")
