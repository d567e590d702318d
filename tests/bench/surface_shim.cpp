/* surface HOODOO [FOLDER]: three ways from particles to a surface, on rock whose true shape is known and on an arch:
 *
 *   field    hoodoo mesh: the rock's smoothed share, cut at 1/2
 *   spheres  Zhu and Bridson's averaged spheres (OpenVDB's rasterizeSmoothSpheres) of the points, meshed by OpenVDB
 *   poisson  Poisson reconstruction (CGAL) from the points of the surface, moved out by their fill, and their normals
 *
 * The ball and the wall are as they were cut (1) and weathered by 1.2 spacings (4). Printed: the distance from the true
 * shape (its spread and its mean, in spacings) and the angle from its normal (root mean square, in degrees), the area that
 * faces the axes within 10 degrees in that of a ball's, volume against the particles' in per cent, wholeness, seconds. FOLDER
 * keeps the meshes. */
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/IO/polygon_soup_io.h>
#include <CGAL/Polygon_mesh_processing/measure.h>
#include <CGAL/Polygon_mesh_processing/polygon_soup_to_polygon_mesh.h>
#include <CGAL/Polygon_mesh_processing/self_intersections.h>
#include <CGAL/Surface_mesh.h>
#include <CGAL/compute_average_spacing.h>
#include <CGAL/poisson_surface_reconstruction.h>

#include <openvdb/io/File.h>
#include <openvdb/openvdb.h>
#include <openvdb/points/PointDataGrid.h>
#include <openvdb/points/PointRasterizeSDF.h>
#include <openvdb/tools/VolumeToMesh.h>

#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <functional>
#include <string>
#include <vector>

namespace PMP = CGAL::Polygon_mesh_processing;
using kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using point = kernel::Point_3;
using vector = kernel::Vector_3;
using mesh = CGAL::Surface_mesh<point>;
using openvdb::Vec3d;

namespace
{
/* A frame of a run, z up. */
struct sample {
    std::string title, folder, name, frame;
    double spacing, volume; /* of the particles, m3 */
    /* Distance from the true shape (out is positive) and its normal at x; false where x does not count. */
    std::function<bool(const Vec3d &x, double &distance, Vec3d &normal)> truth;
};

std::string file_of(const sample &s, const std::string &kind, const std::string &extension)
{
    return s.folder + "/" + kind + "/" + s.name + "." + s.frame + extension;
}

openvdb::points::PointDataGrid::Ptr points_of(const sample &s)
{
    openvdb::io::File file(file_of(s, "points", ".vdb"));
    file.open();
    return openvdb::gridPtrCast<openvdb::points::PointDataGrid>(file.readGrid("points"));
}

mesh from_field(const sample &s, const std::string &hoodoo)
{
    mesh m;
    if (std::system((hoodoo + " mesh " + s.folder + " --no-rocks --frames " +
                     std::to_string(std::atoi(s.frame.c_str())) + " --progress none")
                        .c_str()) ||
        !CGAL::IO::read_polygon_mesh(file_of(s, "mesh", ".ply"), m))
        std::exit(1);
    return m;
}

mesh from_spheres(const sample &s)
{
    const auto points = points_of(s);
    const auto fine = openvdb::math::Transform::createLinearTransform(s.spacing / 2);
    const auto grid =
        openvdb::points::rasterizeSmoothSpheres(*points, 0.5 * s.spacing, 2 * s.spacing, 3.0, fine);
    std::vector<openvdb::Vec3s> x;
    std::vector<openvdb::Vec3I> triangles;
    std::vector<openvdb::Vec4I> quads;
    openvdb::tools::volumeToMesh(*grid, x, triangles, quads, 0.0, 0.0);
    std::vector<point> soup;
    std::vector<std::vector<size_t>> faces;
    for (const auto &v : x)
        soup.emplace_back(v[0], v[1], v[2]);
    for (const auto &t : triangles)
        faces.push_back({t[0], t[2], t[1]});
    for (const auto &q : quads) {
        faces.push_back({q[0], q[2], q[1]});
        faces.push_back({q[0], q[3], q[2]});
    }
    mesh m;
    if (PMP::is_polygon_soup_a_polygon_mesh(faces))
        PMP::polygon_soup_to_polygon_mesh(soup, faces, m);
    return m;
}

mesh from_normals(const sample &s)
{
    std::vector<std::pair<point, vector>> cloud;
    const auto grid = points_of(s);
    for (auto leaf = grid->tree().cbeginLeaf(); leaf; ++leaf) {
        const openvdb::points::AttributeHandle<openvdb::Vec3f> P(leaf->constAttributeArray("P")),
            N(leaf->constAttributeArray("N"));
        const openvdb::points::AttributeHandle<float> fill(leaf->constAttributeArray("viability"));
        for (auto i = leaf->beginIndexOn(); i; ++i) {
            const openvdb::Vec3f n = N.get(*i);
            if (n.lengthSqr() < 0.5)
                continue;
            Vec3d x = grid->transform().indexToWorld(Vec3d(P.get(*i)) + i.getCoord().asVec3d());
            x += Vec3d(n) * ((double(fill.get(*i)) - 0.5) * s.spacing);
            cloud.emplace_back(point(x[0], x[1], x[2]), vector(n[0], n[1], n[2]));
        }
    }
    mesh m;
    using first = CGAL::First_of_pair_property_map<std::pair<point, vector>>;
    using second = CGAL::Second_of_pair_property_map<std::pair<point, vector>>;
    const double apart =
        CGAL::compute_average_spacing<CGAL::Sequential_tag>(cloud, 6, CGAL::parameters::point_map(first()));
    if (!CGAL::poisson_surface_reconstruction_delaunay(cloud.begin(), cloud.end(), first(), second(), m,
                                                       apart))
        m.clear();
    return m;
}

void measure(const sample &s, const char *method, const mesh &m, double seconds)
{
    const double pi = std::acos(-1.0), cosine = std::cos(pi / 18);
    double area = 0, counted = 0, d1 = 0, d2 = 0, angle2 = 0, at_axes = 0;
    for (const auto f : m.faces()) {
        const auto h = m.halfedge(f);
        Vec3d p[3];
        const point q[3] = {m.point(m.source(h)), m.point(m.target(h)), m.point(m.target(m.next(h)))};
        for (int k = 0; k < 3; k++)
            p[k] = Vec3d(q[k].x(), q[k].y(), q[k].z());
        Vec3d n = (p[1] - p[0]).cross(p[2] - p[0]), normal;
        const double a = n.length() / 2;
        if (!(a > 0))
            continue;
        n /= 2 * a;
        double distance;
        if (s.truth) {
            if (!s.truth((p[0] + p[1] + p[2]) / 3, distance, normal))
                continue;
            counted += a;
            d1 += a * distance;
            d2 += a * distance * distance;
            const double t = std::acos(std::min(1.0, std::max(-1.0, n.dot(normal))));
            angle2 += a * t * t;
        }
        area += a;
        for (int d = 0; d < 3; d++)
            at_axes += std::fabs(n[d]) > cosine ? a : 0;
    }
    const bool closed = m.number_of_faces() && CGAL::is_closed(m);
    const bool crosses = m.number_of_faces() && PMP::does_self_intersect(m);
    std::printf("%-8s %-8s", s.title.c_str(), method);
    if (counted > 0)
        std::printf(" %8.3f %8.3f %8.2f",
                    std::sqrt(std::max(0.0, d2 / counted - d1 * d1 / counted / counted)) / s.spacing,
                    d1 / counted / s.spacing, std::sqrt(angle2 / counted) * 180 / pi);
    else
        std::printf(" %8s %8s %8s", "-", "-", "-");
    /* On a ball, this share of the area faces the six axes. */
    std::printf(" %8.2f", at_axes / area / (3 * (1 - cosine)));
    if (s.volume > 0 && closed)
        std::printf(" %+8.2f", 100 * (CGAL::to_double(PMP::volume(m)) / s.volume - 1));
    else
        std::printf(" %8s", "-");
    std::printf(" %9zu %-7s %-8s %7.1f\n", size_t(m.number_of_faces()), closed ? "closed" : "OPEN",
                crosses ? "CROSSES" : "simple", seconds);
    std::fflush(stdout);
}

void compare(const sample &s, const std::string &hoodoo, const std::string &keep)
{
    const std::pair<const char *, std::function<mesh()>> methods[] = {
        {"field", [&] { return from_field(s, hoodoo); }},
        {"spheres", [&] { return from_spheres(s); }},
        {"poisson", [&] { return from_normals(s); }}};
    for (const auto &method : methods) {
        const auto start = std::chrono::steady_clock::now();
        const mesh m = method.second();
        const std::chrono::duration<double> took = std::chrono::steady_clock::now() - start;
        measure(s, method.first, m, took.count());
        if (!keep.empty())
            CGAL::IO::write_polygon_mesh(keep + "/" + s.name + "." + s.frame + "." + method.first + ".ply",
                                         m);
    }
}

void run(const std::string &hoodoo, const std::string &job, const sample &s, const std::string &more)
{
    if (std::system(
            (hoodoo + " run " + job + " --out " + s.folder + " --set output.up=z --progress none " + more)
                .c_str()))
        std::exit(1);
}

/* The particles' volume, from the frame's manifest. */
double manifest_volume(const sample &s)
{
    std::ifstream in(file_of(s, "frames", ".json"));
    const std::string text((std::istreambuf_iterator<char>(in)), std::istreambuf_iterator<char>());
    const std::string key = "\"volume_m3\":";
    const size_t at = text.find(key);
    return at == std::string::npos ? 0 : std::atof(text.c_str() + at + key.size());
}

void write_job(const std::string &name, const std::string &size, const std::string &scene,
               const std::string &more)
{
    std::ofstream(name + ".yaml")
        << "hoodoo: 1\nname: " << name
        << "\nframes: 1-4\nclock: {years_per_frame: 1000}\nrock: {gravity_m_s2: 0}\n"
        << "domain: {size_m: " << size << ", spacing_m: 0.5}\nscene:\n  union:\n"
        << scene << "strata: [{weak_m_per_kyr: 0.2, strong_m_per_kyr: 0.002}]\n"
        << more;
}
} // namespace

int main(int argc, char **argv)
{
    if (argc < 2)
        return 2;
    char *real = realpath(argv[1], nullptr), *top = realpath(".", nullptr),
         scratch[] = "/tmp/hoodoo-surface.XXXXXX";
    const std::string hoodoo = real ? real : "", jobs = std::string(top) + "/jobs";
    char *given = argc > 2 ? realpath(argv[2], nullptr) : nullptr;
    const std::string keep = given ? given : "";
    if (!mkdtemp(scratch) || chdir(scratch))
        return 1;
    openvdb::initialize();
    std::printf("%-8s %-8s %8s %8s %8s %8s %8s %9s\n", "rock", "surface", "spread", "mean", "angle", "axes",
                "volume", "triangles");

    double worn = 0; /* m: in frame 4 three thousand years at 0.2 m/kyr */
    const auto both = [&](sample &s) {
        for (const int frame : {1, 4}) {
            s.title = s.name + " " + std::to_string(frame);
            s.frame = "000" + std::to_string(frame);
            worn = frame == 1 ? 0 : 0.6;
            s.volume = manifest_volume(s);
            compare(s, hoodoo, keep);
        }
    };
    const Vec3d centre(12.2, 11.9, 13.1);
    write_job("ball", "[24, 24, 24]",
              "    - sphere: {center_m: [12.2, 11.9, 13.1], radius_m: 9}\n"
              "    - box: {min_m: [11, 11, 0], max_m: [13, 13, 13], inert: true}\n",
              "");
    sample ball = {"ball", "out_ball", "ball", "0004", 0.5, 0, nullptr};
    ball.truth = [&](const Vec3d &x, double &distance, Vec3d &normal) {
        normal = x - centre;
        distance = normal.length() - (9 - worn);
        normal.normalize();
        return x[2] > centre[2] - 5;
    };
    run(hoodoo, "ball.yaml", ball, "");
    both(ball);

    Vec3d slope(1, 2, 5);
    slope.normalize();
    write_job("wall", "[18, 18, 18]", "    - plane: {point_m: [9, 9, 9], normal: [1, 2, 5]}\n",
              "paint:\n  - {shape: {difference: [box: {min_m: [-1, -1, -1], max_m: [19, 19, 19]}, box: "
              "{min_m: [1.5, 1.5, "
              "1.5], max_m: [16.5, 16.5, 16.5]}]}, inert: true}\n");
    sample wall = {"wall", "out_wall", "wall", "0004", 0.5, 0, nullptr};
    wall.truth = [&](const Vec3d &x, double &distance, Vec3d &normal) {
        normal = slope;
        distance = (x - Vec3d(9)).dot(slope) + worn;
        return (x - Vec3d(9) - distance * slope).length() < 4 && std::fabs(distance) < 2;
    };
    run(hoodoo, "wall.yaml", wall, "");
    both(wall);

    sample arch = {"arch", "out_arch", "demo", "1016", 1, 0, nullptr};
    run(hoodoo, jobs + "/demo.yaml", arch,
        "--frames 1001-1016 --set domain.spacing_m=1 --set clock.years_per_frame=3000 --set "
        "wind.flow.solver=uniform");
    arch.volume = manifest_volume(arch);
    compare(arch, hoodoo, keep);
    if (std::system((std::string("rm -rf ") + scratch).c_str()))
        return 1;
    std::free(real), std::free(top), std::free(given);
    return 0;
}
