#pragma once
/// Lines and numbers of a .msh file, one after the other.

#include <cstdint>
#include <string>
#include <string_view>

namespace osculate::mesh {

/// Numbers as text, or as they stand in memory once `binary` is set. Every fault is a MeshError with the file, the line
/// (in binary files the byte) and the section. Blanks and line ends part numbers, as they do for Gmsh.
class MshNumbers {
public:
    MshNumbers(std::string file, std::string_view text) : file_(std::move(file)), text_(text) {}

    bool binary = false;
    std::string section; ///< in which faults are found

    /// The rest of the line, without its end.
    std::string_view line();
    /// Whether only blanks are left.
    bool at_end();
    /// An integer of 4 bytes.
    int integer(const char* what, int least, int most);
    /// A count or a number of a node or an element, of 8 bytes in version 4.
    std::int64_t size(const char* what, std::int64_t least, std::int64_t most);
    /// A finite number of 8 bytes.
    double real(const char* what);
    /// Goes behind the line `$End<section>`; with `skip` from anywhere in the section, else nothing else may come before it.
    void end_section(bool skip);

    [[nodiscard]] std::size_t place() const { return at_; }
    [[noreturn]] void fail(const std::string& reason) const;

private:
    void skip_blanks();
    std::string_view word();
    template <class T> T taken(const char* what);
    template <class T> T number(const char* what);
    std::int64_t within(const char* what, std::int64_t value, std::int64_t least, std::int64_t most) const;

    std::string file_;
    std::string_view text_;
    std::size_t at_ = 0;    ///< behind what was read
    std::size_t begin_ = 0; ///< of what was read last
};

} // namespace osculate::mesh
