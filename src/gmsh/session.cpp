#include "gmsh/session.hpp"

#include "osculate/core/without_traps.hpp"

#include <cctype>
#include <filesystem>
#include <gmsh.h>

namespace osculate::mesh {

Session::Session() {
    [[maybe_unused]] static const bool once = (gmsh::initialize(0, nullptr, false), true);
    for (auto& [name, value] : options_) {
        const double wanted = value;
        gmsh::option::getNumber(name, value);
        gmsh::option::setNumber(name, wanted);
    }
    gmsh::model::getCurrent(before_);
    gmsh::model::add("osculate");
}

Session::~Session() {
    try {
        gmsh::model::remove();
        gmsh::model::setCurrent(before_);
        for (const auto& [name, value] : options_) gmsh::option::setNumber(name, value);
    } catch (...) { // nothing is left to be done
    }
}

void guarded(const std::string& file, const std::function<void()>& act) {
    const WithoutTraps gmsh;
    try {
        const Session session;
        act();
    } catch (const MeshError&) {
        throw;
    } catch (const std::string& reason) {
        throw MeshError(file, "Gmsh: " + reason);
    } catch (const std::exception& error) {
        throw MeshError(file, std::string("Gmsh: ") + error.what());
    } catch (...) {
        throw MeshError(file, "Gmsh cannot read it");
    }
}

void check_exists(const std::string& path) {
    if (!std::filesystem::is_regular_file(path)) throw MeshError(path, "no such file");
}

double open_geometry(const std::string& file) {
    std::string ending = std::filesystem::path(file).extension().string();
    for (char& c : ending) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    const std::string format = ending == ".step" || ending == ".stp"   ? "step"
                               : ending == ".iges" || ending == ".igs" ? "iges"
                               : ending == ".brep"                     ? "brep"
                                                                       : "";
    if (format.empty())
        throw MeshError(file,
                        "no geometry has the ending '" + ending + "'; osculate reads .step .stp .iges .igs .brep");
    constexpr double millimetre = 1e-3; // lengths in which Gmsh works: its tolerances fit millimetres
    gmsh::option::setString("Geometry.OCCTargetUnit", format == "brep" ? "" : "MM");
    gmsh::vectorpair shapes, volumes;
    gmsh::model::occ::importShapes(file, shapes, true, format);
    gmsh::model::occ::synchronize();
    gmsh::model::getEntities(volumes, 3);
    if (volumes.empty()) throw MeshError(file, "no solid; surfaces alone cannot be meshed");
    return format == "brep" ? 1 : millimetre;
}

} // namespace osculate::mesh
