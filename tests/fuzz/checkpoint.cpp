/// Checkpoints of any content, with a checksum that fits: a file that is damaged does not get this far.

#include "osculate/output/checkpoint_file.hpp"

#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <stdexcept>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace osculate;
    const std::string_view bytes(reinterpret_cast<const char*>(data), size);
    try {
        (void)output::decode(bytes);
    } catch (const std::runtime_error&) { // as it should
    }
    try {
        const std::string once = output::encode(output::decode(output::sealed(bytes)));
        if (output::encode(output::decode(once)) != once) std::abort(); // what was read is what is written
    } catch (const std::runtime_error&) {
    }
    return 0;
}
