#pragma once
/// Plasticity of metals: von Mises' yield condition and isotropic hardening, at any strain.

#include "osculate/material/linear_elastic.hpp"

#include <array>
#include <span>
#include <vector>

namespace osculate::material {

/// Yield stress over equivalent plastic strain, linear between rows and constant after the last.
struct Hardening {
    std::vector<std::array<double, 2>> rows; ///< equivalent plastic strain, ascending from 0; yield stress, Pa, > 0

    [[nodiscard]] double yield_stress(double strain) const;
    /// Integral of the yield stress from 0, J/m^3.
    [[nodiscard]] double work(double strain) const;
    /// Plastic strain a >= start at which q - 3 G (a - start) = yield stress, and the slope of the yield stress there.
    /// @pre q > yield_stress(start)
    struct Return {
        double strain, slope;
    };
    [[nodiscard]] Return solve(double q, double three_G, double start) const;
};

/// Small-strain J2 plasticity between the logarithmic strain e = ln(C)/2 and its work-conjugate stress T, so that rotations
/// cause no strain and plastic flow keeps the volume at any strain:
///     T = K tr(e) 1 + 2 G dev(e - e_p),   |dev T|_eq <= yield stress(a),   de_p = 3/2 dev T / |dev T|_eq da,
/// integrated from the start of a step by backward Euler.
/// [Miehe, Apel, Lambrecht 2002, Comput. Meth. Appl. Mech. Engng 191, 5383; Simo, Hughes 1998, Computational Inelasticity]
class J2Plasticity {
public:
    /// Of each point: e_p, tensor components xx yy zz xy yz zx, and a. All zeros before the first flow.
    static constexpr std::size_t memory = 7;

    J2Plasticity(const LinearElastic& elastic, Hardening hardening)
        : lambda_(elastic.lambda()), mu_(elastic.mu()), hardening_(std::move(hardening)) {}

    /// The law of a step that begins with a memory; empty: none. Strains are Green-Lagrange's, E = (C - 1) / 2.
    class At {
    public:
        At(const J2Plasticity& law, std::span<const double> remembered);

        /// Stored elastic energy per reference volume if nothing flows from here on, J/m^3.
        [[nodiscard]] double energy(const Mat3& E) const;
        /// Stored energy and plastic work of the step, whose derivative is the stress, J/m^3.
        [[nodiscard]] double potential(const Mat3& E) const;
        /// Second Piola-Kirchhoff stress at the step's end, Pa.
        [[nodiscard]] Mat3 pk2(const Mat3& E) const;
        /// dS/dE, Pa, symmetric, in Voigt order with engineering shear strains.
        [[nodiscard]] Mat6 tangent(const Mat3& E) const;
        /// The memory at the step's end.
        void end(const Mat3& E, std::span<double> remembered) const;

    private:
        struct Flow;
        [[nodiscard]] Flow flow(const Mat3& e) const;
        [[nodiscard]] double stored(const Mat3& elastic_strain) const;

        const J2Plasticity& law_;
        Mat3 plastic_ = Mat3::Zero();
        double strain_ = 0;
    };
    [[nodiscard]] At at(std::span<const double> remembered) const { return {*this, remembered}; }
    /// Work dissipated until a memory, J/m^3.
    [[nodiscard]] double dissipated(std::span<const double> remembered) const {
        return hardening_.work(plastic_strain(remembered));
    }
    [[nodiscard]] static double plastic_strain(std::span<const double> remembered) {
        return remembered.empty() ? 0 : remembered[6];
    }

private:
    double lambda_, mu_;
    Hardening hardening_;
};

} // namespace osculate::material
