#include "osculate/mesh/cad_listing.hpp"

#include "gmsh/session.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <gmsh.h>
#include <unordered_map>

namespace osculate::mesh {
namespace {

Vec3 vec(const std::vector<double>& x) {
    return {x.at(0), x.at(1), x.at(2)};
}

std::vector<double> middle_of(int dimension, int tag) {
    std::vector<double> low, high;
    gmsh::model::getParametrizationBounds(dimension, tag, low, high);
    for (std::size_t k = 0; k < low.size(); ++k) low[k] = 0.5 * (low[k] + high[k]);
    return low;
}

/// Radius and axis of a cylinder or sphere from the curvatures at a point of it; of a circle from its curvature and plane.
void add_roundness(CadEntity& entity, int dimension, double unit) {
    const std::vector<double> at = middle_of(dimension, entity.tag);
    if (dimension == 2) {
        std::vector<double> most, least, most_along, least_along;
        gmsh::model::getPrincipalCurvatures(entity.tag, at, most, least, most_along, least_along);
        const double curvature = std::max(std::abs(most.at(0)), std::abs(least.at(0)));
        if (!(curvature > 0)) return;
        entity.radius = unit / curvature;
        if (entity.type != "Cylinder") return;
        const bool straight_is_least = std::abs(least[0]) < std::abs(most[0]);
        entity.axis = vec(straight_is_least ? least_along : most_along).normalized();
    } else {
        std::vector<double> curvature, low, high, first, second;
        gmsh::model::getCurvature(1, entity.tag, at, curvature);
        if (!(curvature.at(0) > 0)) return;
        entity.radius = unit / curvature[0];
        gmsh::model::getParametrizationBounds(1, entity.tag, low, high);
        gmsh::model::getDerivative(1, entity.tag, {low.at(0) + 0.25 * (high.at(0) - low[0])}, first);
        gmsh::model::getDerivative(1, entity.tag, at, second);
        if (const Vec3 normal = vec(first).cross(vec(second)); normal.norm() > 0) entity.axis = normal.normalized();
    }
    // an axis has no sense of direction: the larger component is positive
    Eigen::Index largest = 0;
    if (entity.axis.cwiseAbs().maxCoeff(&largest) > 0 && entity.axis[largest] < 0) entity.axis = -entity.axis;
}

CadEntity described(int dimension, int tag, double unit) {
    CadEntity entity{.tag = tag};
    gmsh::model::getEntityName(dimension, tag, entity.name);
    entity.name.erase(0, entity.name.rfind('/') + 1); // npos + 1 is 0
    gmsh::model::occ::getMass(dimension, tag, entity.measure);
    entity.measure *= std::pow(unit, dimension);
    gmsh::model::occ::getCenterOfMass(dimension, tag, entity.centre[0], entity.centre[1], entity.centre[2]);
    entity.centre *= unit;
    std::vector<int> up, down;
    gmsh::model::getAdjacencies(dimension, tag, up, down);
    entity.of = std::move(up);
    std::sort(entity.of.begin(), entity.of.end());
    if (dimension == 3) return entity;
    gmsh::model::getType(dimension, tag, entity.type);
    if (entity.type == "Cylinder" || entity.type == "Sphere" || entity.type == "Circle")
        add_roundness(entity, dimension, unit);
    return entity;
}

void add_triangles(CadListing& listing, double unit) {
    std::vector<std::size_t> tags;
    std::vector<double> x, parametric;
    gmsh::model::mesh::getNodes(tags, x, parametric);
    std::unordered_map<std::size_t, int> number;
    for (std::size_t k = 0; k < tags.size(); ++k) {
        number.emplace(tags[k], static_cast<int>(k));
        listing.points.emplace_back(unit * x[3 * k], unit * x[3 * k + 1], unit * x[3 * k + 2]);
    }
    for (const CadEntity& face : listing.faces) {
        auto& triangles = listing.triangles.emplace_back();
        std::vector<std::size_t> elements, nodes;
        constexpr int triangle = 2;
        gmsh::model::mesh::getElementsByType(triangle, elements, nodes, face.tag);
        for (std::size_t e = 0; e + 2 < nodes.size(); e += 3)
            triangles.push_back({number.at(nodes[e]), number.at(nodes[e + 1]), number.at(nodes[e + 2])});
    }
}

} // namespace
} // namespace osculate::mesh

using namespace osculate::mesh;
using osculate::Vec3;

extern "C" void osculate_gmsh_list_cad(const std::string* file, CadListing* listing) {
    check_exists(*file);
    guarded(*file, [&] {
        const double unit = open_geometry(*file);
        for (const auto& [dimension, list] :
             {std::pair{3, &listing->solids}, std::pair{2, &listing->faces}, std::pair{1, &listing->edges}}) {
            gmsh::vectorpair entities;
            gmsh::model::getEntities(entities, dimension);
            for (const auto& [same, tag] : entities) list->push_back(described(dimension, tag, unit));
        }
        Vec3 low, high; // a little too large where it is round
        gmsh::model::getBoundingBox(-1, -1, low[0], low[1], low[2], high[0], high[1], high[2]);
        // for a picture: coarse, but round where it is round
        gmsh::option::setNumber("Mesh.MeshSizeMax", 0.08 * (high - low).norm());
        gmsh::option::setNumber("Mesh.MeshSizeMin", 0);
        gmsh::option::setNumber("Mesh.MeshSizeFromCurvature", 24);
        gmsh::option::setNumber("Mesh.Algorithm", 6);
        gmsh::option::setNumber("Mesh.RandomSeed", 1);
        gmsh::model::mesh::generate(2);
        add_triangles(*listing, unit);
    });
}
