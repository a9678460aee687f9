#include "gmsh/check_msh.hpp"

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <sstream>
#include <string_view>
#include <vector>

namespace osculate::mesh {
namespace {

std::string_view next_line(std::string_view& rest) {
    const std::size_t end = rest.find('\n');
    std::string_view line = rest.substr(0, end);
    rest = end == std::string_view::npos ? std::string_view() : rest.substr(end + 1);
    if (line.ends_with('\r')) line.remove_suffix(1);
    return line;
}

/// The counts that a section of nodes or elements begins with.
std::vector<double> counts_of(std::string_view body, bool binary, bool version4) {
    std::vector<double> counts;
    if (binary && version4) {
        std::uint64_t numbers[2];
        if (body.size() < sizeof numbers) return {};
        std::memcpy(numbers, body.data(), sizeof numbers);
        return {static_cast<double>(numbers[0]), static_cast<double>(numbers[1])};
    }
    std::istringstream words{std::string(next_line(body))};
    for (double number = 0; counts.size() < (version4 ? 2 : 1) && words >> number;) counts.push_back(number);
    return counts.size() == (version4 ? 2u : 1u) ? counts : std::vector<double>{};
}

/// Nodes of an element of Gmsh's type, 0 for the rare ones.
std::uint64_t nodes_of_type(int type) {
    constexpr std::uint64_t nodes[] = {0, 2, 3, 4, 4, 8, 6, 5, 3, 6, 9, 10, 27, 18, 14, 1, 8, 20, 15, 13};
    return type >= 0 && type < static_cast<int>(std::size(nodes)) ? nodes[type] : 0;
}

/// Whether the blocks of a section of version 4 stay within it, each announced by three integers and its count.
bool blocks_fit(std::string_view body, bool binary, bool elements, double blocks) {
    const auto skip = [&](std::uint64_t each, std::uint64_t count) {
        if (each != 0 && count > body.size() / each) return false;
        body.remove_prefix(each * count);
        return true;
    };
    if (binary)
        body.remove_prefix(std::min<std::size_t>(body.size(), 4 * sizeof(std::uint64_t)));
    else
        next_line(body);
    for (double b = 0; b < blocks; ++b) {
        int head[3] = {0, 0, 0};
        std::uint64_t count = 0;
        if (binary) {
            if (body.size() < sizeof head + sizeof count) return false;
            std::memcpy(head, body.data(), sizeof head);
            std::memcpy(&count, body.data() + sizeof head, sizeof count);
            body.remove_prefix(sizeof head + sizeof count);
            const std::uint64_t nodes = nodes_of_type(head[2]);
            if (elements && nodes == 0) return true; // Gmsh knows how long they are
            const std::uint64_t parametric = head[2] != 0 ? static_cast<std::uint64_t>(std::clamp(head[0], 0, 3)) : 0;
            if (!skip(sizeof(std::uint64_t) * (elements ? 1 + nodes : 4 + parametric), count)) return false;
            continue;
        }
        std::istringstream words{std::string(next_line(body))};
        if (!(words >> head[0] >> head[1] >> head[2] >> count)) return false;
        if (count > body.size()) return false; // a line each
        for (std::uint64_t line = 0; line < (elements ? count : 2 * count); ++line) {
            if (body.empty()) return false;
            next_line(body);
        }
    }
    return true;
}

/// Whether a section of names holds as many as it says, of dimensions that there are: Gmsh looks neither up.
bool names_fit(std::string_view body) {
    long count = 0;
    if (!(std::istringstream(std::string(next_line(body))) >> count)) return false;
    for (long line = 0; line < count; ++line) {
        int dimension = -1, tag = 0;
        if (body.empty() || !(std::istringstream(std::string(next_line(body))) >> dimension >> tag)) return false;
        if (dimension < 0 || dimension > 3) return false;
    }
    return count >= 0;
}

} // namespace

std::string fault_of_msh(const std::string& path) {
    std::ifstream file(path, std::ios::binary);
    std::string text(static_cast<std::size_t>(std::filesystem::file_size(path)), '\0');
    file.read(text.data(), static_cast<std::streamsize>(text.size()));
    if (!file) return "cannot be read";
    std::string_view rest = text;
    if (next_line(rest) != "$MeshFormat") return "no Gmsh mesh: its first line is not $MeshFormat";
    std::istringstream format{std::string(next_line(rest))};
    std::string version;
    int binary = -1, size = 0;
    format >> version >> binary >> size;
    const bool version4 = version == "4.1",
               version2 = version == "2" || version == "2.0" || version == "2.1" || version == "2.2";
    if ((!version2 && !version4) || (binary != 0 && binary != 1))
        return "version '" + version + "' of Gmsh's format; 2 to 2.2 and 4.1 are read";
    if (size != 8 && (binary == 1 || size != 4)) return "numbers of " + std::to_string(size) + " bytes; 8 are read";
    bool nodes = false, elements = false;
    // Sections one after the other; in binary ones anything may stand, so their ends are looked for, not parsed.
    rest = std::string_view(text).substr(0);
    while (!rest.empty()) {
        const std::string_view line = next_line(rest);
        if (line.empty()) continue;
        if (line.front() != '$') return "text between sections: '" + std::string(line.substr(0, 60)) + "'";
        const std::string name(line.substr(1));
        const std::size_t end = rest.find("$End" + name);
        if (end == std::string_view::npos) return "section $" + name.substr(0, 60) + " has no end";
        const std::string_view body = rest.substr(0, end);
        if (name == "Nodes" || name == "Elements") {
            (name == "Nodes" ? nodes : elements) = true;
            const std::vector<double> counts = counts_of(body, binary == 1, version4);
            if (counts.empty()) return "section $" + name + " does not begin with its counts";
            // A block of version 4 has a line at least, a node or an element four bytes at least.
            for (const double count : counts)
                if (!(count >= 0 && 4 * count <= static_cast<double>(body.size()) + 4))
                    return "section $" + name + " announces more than it holds";
            if (version4 && !blocks_fit(body, binary == 1, name == "Elements", counts[0]))
                return "section $" + name + " has a block that announces more than it holds";
        }
        if (name == "PhysicalNames" && !names_fit(body)) return "section $PhysicalNames does not hold what it says";
        rest.remove_prefix(end);
        next_line(rest);
    }
    if (!nodes || !elements) return std::string("no section $") + (nodes ? "Elements" : "Nodes");
    return "";
}

} // namespace osculate::mesh
