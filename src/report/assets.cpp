#include "report/assets.hpp"

// The assembler takes the files in as they are; report_assets.inc lists them: OSCULATE_ASSET(symbol, "name", "path").
#define OSCULATE_ASSET(symbol, name, path)                                                                             \
    __asm__(".pushsection .rodata\n"                                                                                   \
            ".global osculate_asset_" #symbol "\n"                                                                     \
            "osculate_asset_" #symbol ":\n"                                                                            \
            ".incbin \"" path "\"\n"                                                                                   \
            ".global osculate_asset_end_" #symbol "\n"                                                                 \
            "osculate_asset_end_" #symbol ":\n"                                                                        \
            ".byte 0\n"                                                                                                \
            ".popsection\n");                                                                                          \
    extern "C" const char osculate_asset_##symbol[], osculate_asset_end_##symbol[];
#include "report_assets.inc"
#undef OSCULATE_ASSET

namespace osculate::report {

const std::vector<Asset>& assets() {
    static const std::vector<Asset> all{
#define OSCULATE_ASSET(symbol, name, path)                                                                             \
    {name, {osculate_asset_##symbol, static_cast<std::size_t>(osculate_asset_end_##symbol - osculate_asset_##symbol)}},
#include "report_assets.inc"
#undef OSCULATE_ASSET
    };
    return all;
}

std::string_view asset(std::string_view name) {
    for (const Asset& one : assets())
        if (one.name == name) return one.content;
    return {};
}

} // namespace osculate::report
