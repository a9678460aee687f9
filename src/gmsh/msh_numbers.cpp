#include "gmsh/msh_numbers.hpp"

#include "osculate/mesh/mesh_error.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstring>

namespace osculate::mesh {

void MshNumbers::fail(const std::string& reason) const {
    std::string where;
    if (binary)
        where = "byte " + std::to_string(begin_);
    else
        where = "line " + std::to_string(
                              1 + std::count(text_.begin(), text_.begin() + static_cast<std::ptrdiff_t>(begin_), '\n'));
    throw MeshError(file_, where + (section.empty() ? "" : ", section $" + section) + ": " + reason);
}

std::string_view MshNumbers::line() {
    begin_ = at_;
    const std::size_t end = std::min(text_.find('\n', at_), text_.size());
    std::string_view line = text_.substr(at_, end - at_);
    at_ = std::min(end + 1, text_.size());
    if (line.ends_with('\r')) line.remove_suffix(1);
    return line;
}

void MshNumbers::skip_blanks() {
    while (at_ < text_.size() && (text_[at_] == ' ' || (text_[at_] >= '\t' && text_[at_] <= '\r'))) ++at_;
}

bool MshNumbers::at_end() {
    skip_blanks();
    return at_ == text_.size();
}

std::string_view MshNumbers::word() {
    skip_blanks();
    begin_ = at_;
    std::size_t end = at_;
    while (end < text_.size() && text_[end] != ' ' && !(text_[end] >= '\t' && text_[end] <= '\r')) ++end;
    return text_.substr(at_, end - at_);
}

template <class T> T MshNumbers::taken(const char* what) {
    T value;
    begin_ = at_;
    if (text_.size() - at_ < sizeof value) fail(std::string("the file ends before ") + what);
    std::memcpy(&value, text_.data() + at_, sizeof value);
    at_ += sizeof value;
    return value;
}

template <class T> T MshNumbers::number(const char* what) {
    if (binary) return taken<T>(what);
    const std::string_view found = word();
    std::string_view digits = found;
    if (digits.starts_with('+')) digits.remove_prefix(1);
    T value{};
    const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
    if (error != std::errc() || end != digits.data() + digits.size())
        fail("expected " + std::string(what) + ", found '" + std::string(found.substr(0, 40)) + "'");
    at_ += found.size();
    return value;
}

std::int64_t MshNumbers::within(const char* what, std::int64_t value, std::int64_t least, std::int64_t most) const {
    if (value < least || value > most)
        fail(std::string(what) + " is " + std::to_string(value) + ", not from " + std::to_string(least) + " to " +
             std::to_string(most));
    return value;
}

int MshNumbers::integer(const char* what, int least, int most) {
    return static_cast<int>(within(what, number<std::int32_t>(what), least, most));
}

std::int64_t MshNumbers::size(const char* what, std::int64_t least, std::int64_t most) {
    return within(what, number<std::int64_t>(what), least, most);
}

double MshNumbers::real(const char* what) {
    const double value = number<double>(what);
    if (!std::isfinite(value)) fail(std::string(what) + " is not finite");
    return value;
}

void MshNumbers::end_section(bool skip) {
    const std::string end = "$End" + section;
    if (skip) {
        const std::size_t found = text_.find("\n" + end, at_ > 0 ? at_ - 1 : 0);
        if (found == std::string_view::npos) fail("has no end");
        at_ = found;
    }
    if (const std::string_view found = word(); found != end)
        fail("expected " + end + ", found '" + std::string(found.substr(0, 40)) + "'");
    at_ = std::min(at_ + end.size(), text_.size());
    line();
    section.clear();
}

} // namespace osculate::mesh
