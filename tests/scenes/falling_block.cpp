/// What a run leaves in its files is enough to check that steps were cut where they had to be.

#include "osculate/core/types.hpp"
#include "scenes/program.hpp"

#include <cmath>
#include <vtkDataArray.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkUnstructuredGrid.h>
#include <vtkXMLUnstructuredGridReader.h>

namespace osculate::scenes::OSCULATE_THIS_FILE {
namespace {

namespace fs = std::filesystem;

class FallingBlock : public Program {
protected:
    struct Points {
        std::vector<Vec3> X, u; ///< where they were and how far they have come, m
    };

    Points frame(const std::string& body, std::size_t number) const {
        char name[40];
        std::snprintf(name, sizeof name, "_%05zu.vtu", number);
        vtkNew<vtkXMLUnstructuredGridReader> reader;
        reader->SetFileName((folder / "run/frames" / (body + name)).c_str());
        reader->Update();
        vtkUnstructuredGrid& grid = *reader->GetOutput();
        Points points;
        for (vtkIdType i = 0; i < grid.GetNumberOfPoints(); ++i) {
            points.X.emplace_back(Eigen::Map<const Vec3>(grid.GetPoint(i)));
            points.u.emplace_back(Eigen::Map<const Vec3>(grid.GetPointData()->GetArray("displacement")->GetTuple3(i)));
        }
        return points;
    }
};

/// In flight the trial of a step is free fall from the frame before it: velocities follow from the frames, one after the
/// other, as the mean velocity over a step is the mean of those at its ends.
TEST_F(FallingBlock, IsNeverTakenDeeperThanAllowedByItsFrames) {
    constexpr double facet = 0.1, gravity = 10; // m, m/s^2
    const double touch = std::sqrt(2 * 0.5 / gravity);
    for (const char* allowed : {"1e-2", "1e-4"}) {
        const double g_p = std::stod(allowed) * facet;
        const Csv history(
            run(scene_file("configs/validation/falling_block.yaml"),
                {std::string("stages.fall.control.allowed_interpenetration=") + allowed,
                 "stages.fall.control.step_size=fixed", "stages.fall.duration=0.33", "stages.fall.steps=165"}) /
            "history.csv");
        std::vector<Vec3> velocity;
        double deepest_trial = -1, deepest = -1, first_contact = 0;
        Points before = frame("block", 0);
        velocity.assign(before.u.size(), Vec3::Zero());
        for (std::size_t step = 0; step < history.rows.size(); ++step) {
            const double dt = history.number(step, "dt");
            const Points block = frame("block", step + 1), plate = frame("plate", step + 1);
            double top = -1e300; // of the plate, which is level and does not move
            for (std::size_t i = 0; i < plate.X.size(); ++i) top = std::max(top, plate.X[i].z() + plate.u[i].z());
            for (std::size_t i = 0; i < block.X.size(); ++i) {
                const double trial =
                    block.X[i].z() + before.u[i].z() + dt * velocity[i].z() - 0.5 * gravity * dt * dt - top;
                if (first_contact == 0) deepest_trial = std::max(deepest_trial, -trial);
                deepest = std::max(deepest, -(block.X[i].z() + block.u[i].z() - top));
                velocity[i] = 2 / dt * (block.u[i] - before.u[i]) - velocity[i];
            }
            if (first_contact == 0 && history.number(step, "pair.floor.normal") > 0)
                first_contact = history.number(step, "time");
            before = block;
        }
        const double round_off = 1e-9; // of velocities taken from differences, in units of the height
        EXPECT_LT(deepest_trial, g_p + round_off);
        EXPECT_GT(deepest_trial, 0);
        EXPECT_LT(deepest, round_off) << "it lies in the plate";
        EXPECT_NEAR(first_contact, touch, g_p / (gravity * touch));

        const Csv attempts(folder / "run/steps.csv");
        int cuts = 0;
        for (std::size_t i = 0; i < attempts.rows.size(); ++i) {
            if (attempts.text(i, "verdict") != "retry") continue;
            ++cuts;
            EXPECT_EQ(attempts.text(i, "reason"), "interpenetration");
            EXPECT_EQ(attempts.text(i, "body"), "block");
            EXPECT_LT(attempts.number(i, "value"), -g_p);
        }
        EXPECT_GT(cuts, 0);
    }
}

} // namespace
} // namespace osculate::scenes::OSCULATE_THIS_FILE
