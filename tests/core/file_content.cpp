#include "osculate/core/file_content.hpp"

#include <cstdlib>
#include <fstream>
#include <gtest/gtest.h>
#include <stdexcept>
#include <sys/stat.h>
#include <thread>

namespace osculate::OSCULATE_THIS_FILE {
namespace {

class FileContent : public testing::Test {
protected:
    FileContent() {
        std::string name = (std::filesystem::temp_directory_path() / "osculate_core_XXXXXX").string();
        if (mkdtemp(name.data()) == nullptr) throw std::runtime_error("no temporary folder");
        folder = name;
    }
    ~FileContent() override { std::filesystem::remove_all(folder); }

    std::filesystem::path folder;
    std::error_code error = std::make_error_code(std::errc::io_error); // of another file
};

TEST_F(FileContent, IsAllBytesOfAFile) {
    std::string bytes(200000, 'x'); // more than are read at once
    bytes[1000] = '\0';
    bytes += "\r\n";
    std::ofstream(folder / "file", std::ios::binary) << bytes;
    EXPECT_TRUE(file_content(folder / "file", error) == bytes);
    EXPECT_FALSE(error);
}

TEST_F(FileContent, IsThatOfAPipe) {
    const std::filesystem::path pipe = folder / "pipe";
    ASSERT_EQ(mkfifo(pipe.c_str(), 0600), 0);
    std::thread writer([&] { std::ofstream(pipe) << "through a pipe"; });
    EXPECT_EQ(file_content(pipe, error), "through a pipe");
    EXPECT_FALSE(error);
    writer.join();
}

TEST_F(FileContent, EndsWhereAPipeOrDeviceDoesNot) {
    const std::filesystem::path pipe = folder / "pipe";
    ASSERT_EQ(mkfifo(pipe.c_str(), 0600), 0);
    EXPECT_EQ(file_content(pipe, error), ""); // after 10 s: nobody writes to it
    EXPECT_EQ(error, std::errc::timed_out);
    (void)file_content("/dev/zero", error);
    EXPECT_EQ(error, std::errc::file_too_large);
}

TEST_F(FileContent, SaysWhyAFileCannotBeRead) {
    EXPECT_EQ(file_content(folder / "missing", error), "");
    EXPECT_EQ(error, std::errc::no_such_file_or_directory);
    EXPECT_EQ(file_content(folder, error), "");
    EXPECT_EQ(error, std::errc::is_a_directory);
    EXPECT_EQ(file_content(folder / "missing"), "");
}

} // namespace
} // namespace osculate::OSCULATE_THIS_FILE
