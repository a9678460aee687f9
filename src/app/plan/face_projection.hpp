#pragma once
/// Weights of nodes of faces with midside nodes that follow a surface.

#include "osculate/contact/dual_weights.hpp"
#include "osculate/mesh/surface_faces.hpp"

#include <map>
#include <vector>

namespace osculate::app {

/// What the nodes of slave faces follow: at node k the mean over its faces f of the faces' best approximations to the master,
///     x_k = sum_f w_fk (M_f^-1 P_f x)_k / sum_f w_fk,   M_f = int N N^T dA,   P_f = int N N'^T dA,   w_fk = int N_k dA,
/// N the shape functions of the slave face and N' those of the master's faces, over what of the face is above the master. So
/// the mean follows every motion that both sides can show; and as sum_k w_fk (M_f^-1 P_f)_k = int N' dA, what loads the slave
/// like a uniform pressure loads the master likewise: the patch test. On linear faces the weights are those of
/// contact::DualWeights. Corners of six-node faces have w_fk = 0, and count by the faces' areas, for such loads have no share in them.
class FaceProjection {
public:
    /// @param facets   of the slave, as those of the weights, and their faces
    /// @param master   facets of the master, as those of the surface of the weights, and their faces
    /// @param X        reference positions of all nodes, m
    FaceProjection(const std::vector<mesh::Facet>& facets, const std::vector<mesh::SurfaceFace>& faces,
                   const std::vector<mesh::Facet>& master, const std::vector<mesh::SurfaceFace>& master_faces,
                   const std::vector<Vec3>& X);

    /// Adds a facet of the slave that is up to date in the weights.
    void add(const contact::DualWeights& weights, Index facet);
    /// Weights of nodes of the master, by nodes of the slave that are above it.
    [[nodiscard]] std::map<Index, std::map<Index, double>> weights() const;

private:
    using Numbers = std::array<int, 4>;
    /// The faces of facets, and which of their nodes are the facets' corners.
    struct Pieces {
        std::vector<mesh::SurfaceFace> faces;
        std::vector<std::size_t> face; ///< (facets)
        std::vector<Numbers> corner;   ///< (facets) numbers of nodes of the face
        Pieces(const std::vector<mesh::Facet>& facets, const std::vector<mesh::SurfaceFace>& all);
        /// Shape functions of the face of a facet, at the point where the facet's own have given values.
        [[nodiscard]] Vector at(std::size_t facet, const contact::DualFunctions::Row4& phi,
                                const std::vector<Vec3>& X) const;
    };
    struct Sum {
        Matrix M;
        Vector w;
        double area = 0, covered = 0;
        std::map<Index, Vector> P;
    };

    const std::vector<Vec3>& X_;
    Pieces slave_, master_;
    std::vector<Sum> sums_; ///< (slave faces)
};

} // namespace osculate::app
