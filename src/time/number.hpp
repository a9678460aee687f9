#pragma once
/// Numbers in messages.

#include <sstream>
#include <string>

namespace osculate::time {

inline std::string number(double value) {
    std::ostringstream text;
    text << value;
    return text.str();
}

} // namespace osculate::time
