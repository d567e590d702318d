/* mesh_check FILE... [--from FINE]: what CGAL, which shares nothing with hoodoo, says of triangle meshes (PLY, OBJ). One line of JSON
 * a file: is it one closed oriented manifold, outwards, without triangles that cross; volume, area, components. With --from, how far the farthest vertex of the mesh FINE is
 * from it. */
#include <CGAL/AABB_face_graph_triangle_primitive.h>
#include <CGAL/AABB_traits.h>
#include <CGAL/AABB_tree.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/IO/polygon_soup_io.h>
#include <CGAL/Polygon_mesh_processing/connected_components.h>
#include <CGAL/Polygon_mesh_processing/measure.h>
#include <CGAL/Polygon_mesh_processing/orient_polygon_soup.h>
#include <CGAL/Polygon_mesh_processing/orientation.h>
#include <CGAL/Polygon_mesh_processing/polygon_soup_to_polygon_mesh.h>
#include <CGAL/Polygon_mesh_processing/self_intersections.h>
#include <CGAL/Polygon_mesh_processing/shape_predicates.h>
#include <CGAL/Surface_mesh.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <string>
#include <vector>

namespace PMP = CGAL::Polygon_mesh_processing;
using kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using mesh = CGAL::Surface_mesh<kernel::Point_3>;

static const char *word(bool b)
{
    return b ? "true" : "false";
}

static double farthest(const mesh &m, const std::vector<kernel::Point_3> &points)
{
    using primitive = CGAL::AABB_face_graph_triangle_primitive<mesh>;
    CGAL::AABB_tree<CGAL::AABB_traits<kernel, primitive>> tree(faces(m).begin(), faces(m).end(), m);
    double most = 0;
    for (const auto &p : points)
        most = std::max(most, CGAL::to_double(tree.squared_distance(p)));
    return std::sqrt(most);
}

int main(int argc, char **argv)
{
    std::vector<kernel::Point_3> fine;
    std::vector<std::vector<size_t>> unused;
    if (argc > 3 && std::string(argv[argc - 2]) == "--from") {
        if (!CGAL::IO::read_polygon_soup(argv[argc - 1], fine, unused))
            return std::fprintf(stderr, "%s: unreadable\n", argv[argc - 1]), 1;
        argc -= 2;
    }
    for (int f = 1; f < argc; f++) {
        std::vector<kernel::Point_3> points;
        std::vector<std::vector<size_t>> faces;
        if (!CGAL::IO::read_polygon_soup(argv[f], points, faces))
            return std::fprintf(stderr, "%s: unreadable\n", argv[f]), 1;
        const size_t n_points = points.size();
        const bool manifold = PMP::is_polygon_soup_a_polygon_mesh(faces);
        /* Where it is none, the copy with vertices doubled until it is one still shows what crosses. */
        if (!manifold)
            PMP::orient_polygon_soup(points, faces);
        mesh m;
        PMP::polygon_soup_to_polygon_mesh(points, faces, m);
        std::vector<std::pair<mesh::Face_index, mesh::Face_index>> crossing;
        size_t flat = 0;
        for (const auto face : m.faces())
            flat += PMP::is_degenerate_triangle_face(face, m);
        PMP::self_intersections(m, std::back_inserter(crossing));
        const bool closed = CGAL::is_closed(m), whole = manifold && closed;
        auto component = m.add_property_map<mesh::Face_index, size_t>("f:component", 0).first;
        const size_t components = PMP::connected_components(m, component);
        double low = 1e9;
        for (const auto face : m.faces()) {
            const auto h = m.halfedge(face);
            const kernel::Point_3 p[3] = {m.point(m.source(h)), m.point(m.target(h)),
                                          m.point(m.target(m.next(h)))};
            double longest = 0;
            for (int k = 0; k < 3; k++)
                longest = std::max(longest, CGAL::to_double(CGAL::squared_distance(p[k], p[(k + 1) % 3])));
            low =
                std::min(low, 2 * std::sqrt(CGAL::to_double(CGAL::squared_area(p[0], p[1], p[2])) / longest));
        }
        std::printf(
            "{\"file\": \"%s\", \"vertices\": %zu, \"triangles\": %zu, \"manifold\": %s, \"closed\": %s, "
            "\"valid\": %s, \"outward\": %s, \"degenerate\": %zu, \"crossing\": %zu, \"components\": %zu, "
            "\"volume\": %.9g, \"area\": %.9g, \"least_height\": %.9g, "
            "\"farthest\": %.9g}\n",
            argv[f], n_points, faces.size(), word(manifold), word(closed),
            word(CGAL::is_valid_polygon_mesh(m)),
            word(whole && (components > 1 ? PMP::does_bound_a_volume(m) : PMP::is_outward_oriented(m))), flat,
            crossing.size(), components, whole ? PMP::volume(m) : NAN, PMP::area(m), low,
            fine.empty() ? 0 : farthest(m, fine));
    }
    return 0;
}
