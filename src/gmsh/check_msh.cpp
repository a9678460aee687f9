#include "gmsh/check_msh.hpp"

#include "gmsh/msh_numbers.hpp"
#include "gmsh/tag_set.hpp"
#include "osculate/core/file_content.hpp"
#include "osculate/mesh/mesh_error.hpp"

#include <array>
#include <limits>
#include <set>
#include <utility>

namespace osculate::mesh {
namespace {

constexpr int most_int = std::numeric_limits<int>::max();
constexpr std::int64_t most_size = std::numeric_limits<std::int64_t>::max();

/// Dimension and number of nodes of Gmsh's types of elements, from 1 on; {-1, 0} for those of no fixed number.
struct ElementShape {
    int dimension, nodes;
};
constexpr ElementShape shapes[] = {{-1, 0}, {1, 2},  {2, 3},  {2, 4},  {3, 4},  {3, 8},  {3, 6},  {3, 5},
                                   {1, 3},  {2, 6},  {2, 9},  {3, 10}, {3, 27}, {3, 18}, {3, 14}, {0, 1},
                                   {2, 8},  {3, 20}, {3, 15}, {3, 13}, {2, 9},  {2, 10}, {2, 12}, {2, 15},
                                   {2, 15}, {2, 21}, {1, 4},  {1, 5},  {1, 6},  {3, 20}, {3, 35}, {3, 56}};

class MshCheck {
public:
    MshCheck(const std::string& path, std::string_view text) : in_(path, text), text_(text) {}

    std::string allowed() {
        read_format();
        while (!in_.at_end()) {
            const std::size_t begin = in_.place();
            const std::string_view line = in_.line();
            if (line.front() != '$') in_.fail("text between sections: '" + std::string(line.substr(0, 40)) + "'");
            std::string name(line.substr(1));
            while (name.ends_with(' ')) name.pop_back();
            if (name.size() > 40) in_.fail("no section has the name '" + name.substr(0, 40) + "...'");
            in_.section = name;
            const bool known = read(name);
            in_.end_section(!known);
            if (!known) continue;
            if (!read_.insert(name).second) in_.fail("section $" + name + " is there twice");
            kept_ += text_.substr(begin, in_.place() - begin);
            if (!kept_.ends_with('\n')) kept_ += '\n';
        }
        for (const char* needed : {"Nodes", "Elements"})
            if (!read_.contains(needed)) in_.fail("the file ends without a section $" + std::string(needed));
        return std::move(kept_);
    }

private:
    void read_format() {
        if (in_.line() != "$MeshFormat") in_.fail("no Gmsh mesh: its first line is not $MeshFormat");
        in_.section = "MeshFormat";
        const std::string_view line = in_.line();
        const std::string_view version = line.substr(0, line.find(' '));
        version4_ = version == "4.1";
        dimensions_of_names_ = version != "2" && version != "2.0";
        if (!version4_ && version != "2" && version != "2.0" && version != "2.1" && version != "2.2")
            in_.fail("version '" + std::string(version.substr(0, 40)) +
                     "' of Gmsh's format; 2 to 2.2 and 4.1 are read");
        MshNumbers rest("", line.substr(version.size()));
        int binary = -1, bytes = 0;
        try {
            binary = rest.integer("", 0, 1);
            bytes = rest.integer("", 0, most_int);
        } catch (const MeshError&) {
            in_.fail("expected the version, 0 or 1 and the bytes of a number, found '" +
                     std::string(line.substr(0, 40)) + "'");
        }
        if (bytes != 8 && (binary == 1 || bytes != 4))
            in_.fail("numbers of " + std::to_string(bytes) + " bytes; 8 are read");
        in_.binary = binary == 1;
        if (in_.binary && in_.integer("the number 1", std::numeric_limits<int>::min(), most_int) != 1)
            in_.fail("written on a machine of the other order of bytes");
        in_.end_section(false);
        kept_ = text_.substr(0, in_.place());
    }

    /// False for a section that is left out.
    bool read(const std::string& name) {
        if (name == "PhysicalNames")
            read_names();
        else if (name == "Entities" && version4_)
            read_entities();
        else if (name == "Nodes")
            version4_ ? read_nodes4() : read_nodes2();
        else if (name == "Elements")
            version4_ ? read_elements4() : read_elements2();
        else if (name == "PartitionedEntities")
            fail_partitioned();
        else if (name == "ParametricNodes")
            in_.fail("nodes with parameters are read in version 4.1 only; save without (Mesh.SaveParametric)");
        else
            return false;
        return true;
    }

    /// Lines of text in binary files, too.
    void read_names() {
        const bool binary = std::exchange(in_.binary, false);
        const int count = in_.integer("the number of names", 0, most_int);
        for (int n = 0; n < count; ++n) {
            if (dimensions_of_names_) in_.integer("the dimension of a name", 0, 3);
            in_.integer("the number of a name", -most_int, most_int);
            const std::string_view rest = in_.line();
            const std::size_t open = rest.find_first_not_of(" \t"), close = rest.find_last_not_of(" \t");
            if (open == std::string_view::npos || close <= open || rest[open] != '"' ||
                rest.find('"', open + 1) != close || close - open > most_letters)
                in_.fail("expected a name of up to 127 letters in double quotes, found '" +
                         std::string(rest.substr(0, 40)) + "'");
        }
        in_.binary = binary;
    }

    void read_entities() {
        std::array<std::int64_t, 4> counts;
        for (std::int64_t& count : counts) count = in_.size("the number of entities", 0, most_int);
        for (std::size_t dimension = 0; dimension < 4; ++dimension)
            for (std::int64_t e = 0; e < counts[dimension]; ++e) {
                const int tag = in_.integer("the number of an entity", 0, most_int);
                if (!entities_[dimension].insert(tag).second)
                    in_.fail("entity " + std::to_string(tag) + " of dimension " + std::to_string(dimension) +
                             " is there twice");
                for (int d = 0; d < (dimension == 0 ? 3 : 6); ++d) in_.real("a bound of an entity");
                for (std::int64_t p = in_.size("the number of groups", 0, most_int); p > 0; --p)
                    in_.integer("the number of a group", -most_int, most_int);
                if (dimension == 0) continue;
                for (std::int64_t b = in_.size("the number of bounding entities", 0, most_int); b > 0; --b) {
                    const int bound = in_.integer("the number of a bounding entity", -most_int, most_int);
                    if (!entities_[dimension - 1].contains(std::abs(bound)))
                        in_.fail("entity " + std::to_string(tag) + " is bounded by " + std::to_string(bound) +
                                 ", which does not exist");
                }
            }
    }

    /// A line of text in binary files, too.
    int count_as_text(const char* what) {
        const bool binary = std::exchange(in_.binary, false);
        const int count = in_.integer(what, 0, most_int);
        if (binary) in_.line();
        in_.binary = binary;
        return count;
    }

    void read_nodes2() {
        const int count = count_as_text("the number of nodes");
        for (int n = 0; n < count; ++n) {
            nodes_.add(in_.integer("the number of a node", 1, most_int));
            read_point(0);
        }
        finish_nodes();
    }

    void read_nodes4() {
        const std::int64_t blocks = in_.size("the number of blocks", 0, most_size);
        const std::int64_t total = in_.size("the number of nodes", 0, most_size);
        const std::int64_t least = in_.size("the least number of a node", 0, most_size);
        const std::int64_t most = in_.size("the greatest number of a node", least, most_size);
        std::int64_t read = 0;
        for (std::int64_t b = 0; b < blocks; ++b) {
            const int dimension = in_.integer("the dimension of an entity", 0, 3);
            in_.integer("the number of an entity", 0, most_int);
            const int parametric = in_.integer("whether nodes have parameters", 0, 1);
            const std::int64_t count = in_.size("the number of nodes of a block", 0, total - read);
            for (std::int64_t n = 0; n < count; ++n)
                nodes_.add(in_.size("the number of a node", std::max<std::int64_t>(least, 1), most));
            for (std::int64_t n = 0; n < count; ++n) read_point(parametric * dimension);
            read += count;
        }
        finish_nodes();
        check_announced("nodes", total, read, {least, most}, {nodes_.least(), nodes_.most()});
    }

    using Range = std::pair<std::int64_t, std::int64_t>;

    /// Gmsh's arrays have the lengths that are announced.
    void check_announced(const std::string& what, std::int64_t total, std::int64_t read, Range announced,
                         Range found) const {
        if (read != total)
            in_.fail("announces " + std::to_string(total) + " " + what + " and has " + std::to_string(read));
        if (total > 0 && found != announced)
            in_.fail("numbers of " + what + " are from " + std::to_string(found.first) + " to " +
                     std::to_string(found.second) + ", announced are " + std::to_string(announced.first) + " to " +
                     std::to_string(announced.second));
    }

    void read_point(int parameters) {
        for (int d = 0; d < 3; ++d) in_.real("a coordinate");
        for (int d = 0; d < parameters; ++d) in_.real("a parameter");
    }

    void finish_nodes() {
        if (const std::int64_t twice = nodes_.finish(); twice != 0)
            in_.fail("node " + std::to_string(twice) + " is there twice");
    }

    void read_elements2() {
        const int total = count_as_text("the number of elements");
        int read = 0;
        while (read < total) {
            if (in_.binary) {
                const ElementShape& shape = read_type();
                const int count = in_.integer("the number of elements of a block", 1, total - read);
                const int tags = in_.integer("the number of tags", 0, most_tags);
                for (int e = 0; e < count; ++e) {
                    const int element = in_.integer("the number of an element", 1, most_int);
                    read_tags(tags);
                    for (int n = 0; n < shape.nodes; ++n)
                        check_node(element, in_.integer("the number of a node", 1, most_int));
                }
                read += count;
                continue;
            }
            const int element = in_.integer("the number of an element", 1, most_int);
            const ElementShape& shape = read_type();
            read_tags(in_.integer("the number of tags", 0, most_tags));
            for (int n = 0; n < shape.nodes; ++n) check_node(element, in_.integer("the number of a node", 1, most_int));
            ++read;
        }
    }

    /// Group, entity, and of old files partitions.
    void read_tags(int count) {
        for (int t = 0; t < count; ++t) {
            const int tag = in_.integer("a tag", -most_int, most_int);
            if (t == 1 && tag < 0) in_.fail("the number of an entity is " + std::to_string(tag));
            if (t > 1 && tag != 0) fail_partitioned();
        }
    }

    [[noreturn]] void fail_partitioned() const { in_.fail("the mesh is cut into partitions; save it whole"); }

    void read_elements4() {
        const std::int64_t blocks = in_.size("the number of blocks", 0, most_size);
        const std::int64_t total = in_.size("the number of elements", 0, most_size);
        const std::int64_t least = in_.size("the least number of an element", 0, most_size);
        const std::int64_t most = in_.size("the greatest number of an element", least, most_size);
        std::int64_t read = 0, lowest = most_size, highest = 0;
        for (std::int64_t b = 0; b < blocks; ++b) {
            const int dimension = in_.integer("the dimension of an entity", 0, 3);
            in_.integer("the number of an entity", 0, most_int);
            const ElementShape& shape = read_type();
            if (shape.dimension != dimension) in_.fail("elements are of another dimension than their entity");
            const std::int64_t count = in_.size("the number of elements of a block", 0, total - read);
            for (std::int64_t e = 0; e < count; ++e) {
                const std::int64_t element =
                    in_.size("the number of an element", std::max<std::int64_t>(least, 1), most);
                lowest = std::min(lowest, element);
                highest = std::max(highest, element);
                for (int n = 0; n < shape.nodes; ++n)
                    check_node(element, in_.size("the number of a node", 1, most_size));
            }
            read += count;
        }
        check_announced("elements", total, read, {least, most}, {lowest, highest});
    }

    const ElementShape& read_type() {
        const int type = in_.integer("the type of an element", 1, most_int);
        if (type >= static_cast<int>(std::size(shapes)))
            in_.fail("elements of type " + std::to_string(type) + " are not read");
        return shapes[type];
    }

    void check_node(std::int64_t element, std::int64_t node) const {
        if (!nodes_.contains(node))
            in_.fail("element " + std::to_string(element) + " has node " + std::to_string(node) +
                     ", which does not exist");
    }

    static constexpr int most_tags = 1000;
    static constexpr std::size_t most_letters = 128;

    MshNumbers in_;
    std::string_view text_;
    bool version4_ = false, dimensions_of_names_ = true;
    std::set<std::string> read_;
    std::array<std::set<int>, 4> entities_;
    TagSet nodes_;
    std::string kept_;
};

} // namespace

std::string checked_msh(const std::string& path) {
    std::error_code error;
    const std::string text = file_content(path, error);
    if (error) throw MeshError(path, "cannot be read");
    return MshCheck(path, text).allowed();
}

} // namespace osculate::mesh
