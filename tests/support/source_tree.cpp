#include "support/source_tree.hpp"

namespace osculate::support {

std::string source_tree() {
    return OSCULATE_SOURCE_DIR;
}

} // namespace osculate::support
