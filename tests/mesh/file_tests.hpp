#pragma once
/// Tests that write a small mesh file and read it.

#include "osculate/mesh/mesh_error.hpp"
#include "osculate/mesh/mesh_file.hpp"

#include <filesystem>
#include <fstream>
#include <gmock/gmock.h>
#include <string>

namespace osculate::mesh::fixtures {

class FileTest : public ::testing::Test {
protected:
    std::filesystem::path folder =
        std::filesystem::path(::testing::TempDir()) /
        (std::string("osculate_") + ::testing::UnitTest::GetInstance()->current_test_info()->test_suite_name() + "_" +
         ::testing::UnitTest::GetInstance()->current_test_info()->name());

    void SetUp() override {
        std::filesystem::remove_all(folder);
        std::filesystem::create_directory(folder);
    }
    void TearDown() override { std::filesystem::remove_all(folder); }

    [[nodiscard]] std::string write(const std::string& name, const std::string& text) const {
        std::ofstream(folder / name, std::ios::binary) << text;
        return (folder / name).string();
    }

    [[nodiscard]] static Mesh mesh_of(const std::string& path, const MeshFileOptions& options = {}) {
        return make_mesh(read_mesh_file(path), options);
    }

    /// The message of the error, which alone may speak: nothing goes to the terminal.
    [[nodiscard]] static std::string error_of(const std::string& path, const MeshFileOptions& options = {}) {
        ::testing::internal::CaptureStderr();
        ::testing::internal::CaptureStdout();
        std::string message;
        try {
            (void)mesh_of(path, options);
        } catch (const MeshError& caught) {
            message = caught.what();
        }
        EXPECT_EQ(::testing::internal::GetCapturedStdout(), "");
        EXPECT_EQ(::testing::internal::GetCapturedStderr(), "");
        return message;
    }

    [[nodiscard]] static MeshFileOptions repairing(std::initializer_list<Repair> repairs) {
        MeshFileOptions options;
        for (const Repair r : repairs) options.repairs.wanted[static_cast<std::size_t>(r)] = true;
        return options;
    }
};

} // namespace osculate::mesh::fixtures
