#include "osculate/output/series.hpp"
#include "output/temporary_folder.hpp"

#include <gmock/gmock.h>
#include <vtkSmartPointer.h>
#include <vtkXMLDataElement.h>
#include <vtkXMLUtilities.h>

namespace osculate::output::OSCULATE_THIS_FILE {
namespace {

using testing::AllOf;
using testing::HasSubstr;

class SeriesFile : public InTemporaryFolder {
protected:
    struct Row {
        double time;
        int part;
        std::string name, file;
        bool operator==(const Row&) const = default;
    };

    /// The rows of series.pvd as an XML parser sees them; fails when it is not a whole collection.
    std::vector<Row> rows() const {
        std::vector<Row> result;
        const auto path = folder / "series.pvd";
        const auto root = vtkSmartPointer<vtkXMLDataElement>::Take(vtkXMLUtilities::ReadElementFromFile(path.c_str()));
        EXPECT_NE(root.Get(), nullptr) << content(path);
        if (!root) return result;
        EXPECT_STREQ(root->GetAttribute("type"), "Collection");
        vtkXMLDataElement* collection = root->FindNestedElementWithName("Collection");
        for (int i = 0; collection != nullptr && i < collection->GetNumberOfNestedElements(); ++i) {
            vtkXMLDataElement* entry = collection->GetNestedElement(i);
            Row row{};
            entry->GetScalarAttribute("part", row.part);
            row.time = std::stod(entry->GetAttribute("timestep"));
            row.name = entry->GetAttribute("name");
            row.file = entry->GetAttribute("file");
            result.push_back(row);
        }
        return result;
    }
};

TEST_F(SeriesFile, ListsEveryFileWithTimePartAndName) {
    Series series(folder);
    series.add(0, "tube", "frames/tube_0000.vtu");
    series.add(0, "sliding.slave", "frames/sliding.slave_0000.vtp");
    series.add(0.1, "tube", "frames/tube_0001.vtu");
    series.flush();
    const std::vector<Row> expected{{0, 0, "tube", "frames/tube_0000.vtu"},
                                    {0, 1, "sliding.slave", "frames/sliding.slave_0000.vtp"},
                                    {0.1, 0, "tube", "frames/tube_0001.vtu"}};
    EXPECT_EQ(rows(), expected);
}

TEST_F(SeriesFile, IsWholeAtEveryMoment) {
    Series series(folder / "new" / "run");
    folder = folder / "new" / "run";
    EXPECT_TRUE(rows().empty());
    series.add(1, "tube", "a.vtu");
    EXPECT_TRUE(rows().empty()) << "a file is listed before flush()";
    series.flush();
    EXPECT_EQ(rows().size(), 1U);
    EXPECT_EQ(files_in(folder), 1U) << "a part file was left behind";
}

TEST_F(SeriesFile, ForgetsTheRunOfBefore) {
    Series before(folder);
    before.add(1, "tube", "a.vtu");
    before.flush();
    const Series after(folder);
    EXPECT_TRUE(rows().empty());
}

TEST_F(SeriesFile, EscapesWhatXmlReserves) {
    const std::string name = "a<b>&\"c\" 'd'";
    Series series(folder);
    series.add(0, name, "frames/x&y.vtu");
    series.flush();
    const std::vector<Row> expected{{0, 0, name, "frames/x&y.vtu"}};
    EXPECT_EQ(rows(), expected);
}

TEST_F(SeriesFile, FullDiskLeavesTheSeriesOfBefore) {
    Series series(folder);
    series.add(0, "tube", "a.vtu");
    series.flush();
    for (int i = 1; i < 100; ++i) series.add(i, "tube", "b.vtu");
    std::string message;
    {
        const FullDisk full(500);
        message = runtime_error_of([&] { series.flush(); });
    }
    EXPECT_THAT(message, AllOf(HasSubstr("series.pvd"), HasSubstr("File too large")));
    EXPECT_EQ(rows().size(), 1U);
}

TEST_F(SeriesFile, ErrorNamesPathAndReason) {
    std::ofstream(folder / "file") << "in the way";
    EXPECT_THAT(runtime_error_of([&] { const Series series(folder / "file"); }),
                AllOf(HasSubstr((folder / "file").string()), HasSubstr("irectory")));
}

} // namespace
} // namespace osculate::output::OSCULATE_THIS_FILE
