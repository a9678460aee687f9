#include "osculate/report/encode.hpp"

#include <stdexcept>
#include <zlib.h>

namespace osculate::report {

Bytes deflated(const Bytes& bytes) {
    uLongf size = compressBound(static_cast<uLong>(bytes.size()));
    Bytes result(size);
    if (compress2(result.data(), &size, bytes.data(), static_cast<uLong>(bytes.size()), Z_BEST_COMPRESSION) != Z_OK)
        throw std::runtime_error("zlib cannot compress " + std::to_string(bytes.size()) + " bytes");
    result.resize(size);
    return result;
}

Bytes inflated(const Bytes& bytes) {
    z_stream stream{};
    if (inflateInit(&stream) != Z_OK) throw std::runtime_error("zlib cannot start");
    Bytes result, part(1 << 16);
    stream.next_in = const_cast<Bytef*>(bytes.data()); // zlib reads it only
    stream.avail_in = static_cast<uInt>(bytes.size());
    int state = Z_OK;
    while (state == Z_OK) {
        stream.next_out = part.data();
        stream.avail_out = static_cast<uInt>(part.size());
        state = inflate(&stream, Z_NO_FLUSH);
        result.insert(result.end(), part.data(), part.data() + (part.size() - stream.avail_out));
    }
    inflateEnd(&stream);
    if (state != Z_STREAM_END) throw std::runtime_error("not the bytes of a compressed array");
    return result;
}

std::string base64(const Bytes& bytes) {
    static constexpr char letters[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string text;
    text.reserve((bytes.size() + 2) / 3 * 4);
    for (std::size_t i = 0; i < bytes.size(); i += 3) {
        const std::size_t left = bytes.size() - i;
        const unsigned a = bytes[i], b = left > 1 ? bytes[i + 1] : 0U, c = left > 2 ? bytes[i + 2] : 0U;
        const unsigned word = a << 16 | b << 8 | c;
        text += letters[word >> 18];
        text += letters[word >> 12 & 63];
        text += left > 1 ? letters[word >> 6 & 63] : '=';
        text += left > 2 ? letters[word & 63] : '=';
    }
    return text;
}

} // namespace osculate::report
