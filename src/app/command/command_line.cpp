#include "osculate/app/command_line.hpp"

#include "app/check/check.hpp"
#include "app/command/init_command.hpp"
#include "app/command/mesh_command.hpp"
#include "app/command/mistyped.hpp"
#include "app/command/result_commands.hpp"
#include "app/command/run_script.hpp"
#include "app/command/study_command.hpp"
#include "app/command/surface_command.hpp"
#include "app/run/distributed.hpp"
#include "osculate/app/load.hpp"
#include "osculate/app/processes.hpp"
#include "osculate/app/report.hpp"
#include "osculate/app/run.hpp"
#include "osculate/app/run_report.hpp"
#include "osculate/app/surface_study.hpp"
#include "osculate/app/version.hpp"
#include "osculate/core/error.hpp"
#include "osculate/deck/import_deck.hpp"
#include "osculate/mesh/deck.hpp"
#include "osculate/mesh/mesh_error.hpp"
#include "osculate/mesh/repair.hpp"
#include "osculate/scene/keys.hpp"
#include "osculate/scene/schema.hpp"
#include "osculate/scene/study.hpp"

#include <CLI/CLI.hpp>
#include <cstdio>
#include <fmt/format.h>
#include <new>
#include <optional>
#include <thread>

namespace osculate::app {

namespace {

enum ExitCode { done = 0, bad_scene = 2, gave_up = 3, bug = 4, lossy_import = 5 };

struct Arguments {
    std::string scene, output, key_path, run_folder, checkpoint_every, from, emit, schema = "scene";
    std::vector<std::string> changes;
    FolderOptions folder;
    int threads = std::max(1, static_cast<int>(std::thread::hardware_concurrency())), processes = 0;
    bool quiet = false, distributed = false;
    SurfaceOptions surface;
    StudyOptions study;
    bool formulas = false, list = false, json = false;
    MeshCommand mesh;
    std::string deck, units = "si";
    bool allow_loss = false;

    [[nodiscard]] RunOptions run_options() const {
        return {output, threads,
                quiet,  checkpoint_every.empty() ? CheckpointEvery{} : parse_checkpoint_every(checkpoint_every),
                true,   folder};
    }
    [[nodiscard]] std::vector<scene::Override> overrides() const {
        std::vector<scene::Override> result;
        for (const std::string& change : changes) {
            const std::size_t equals = change.find('=');
            result.push_back({change.substr(0, equals), change.substr(equals + 1)});
        }
        return result;
    }
};

std::string assignment(const std::string& text) {
    const std::size_t equals = text.find('=');
    return equals != std::string::npos && equals > 0 ? "" : "expected name=value, found '" + text + "'";
}

void add_folder(CLI::App* command, Arguments& arguments, const std::string& what) {
    command->add_option("-o,--output", arguments.output, what)->type_name("DIR");
    CLI::Option* force =
        command->add_flag("--force", arguments.folder.force,
                          "Write into a folder that holds other files; overwrite files of the same name, delete none");
    command->add_flag("--new", arguments.folder.numbered, "If DIR is not empty, use DIR-2, DIR-3, ...")
        ->excludes(force);
}

/// Says which folder was taken, where it had to be chosen.
void show_numbered(const Arguments& arguments, const std::filesystem::path& folder) {
    if (arguments.folder.numbered) print(fmt::format("{}\n", folder.string()));
}

void add_changes(CLI::App* command, Arguments& arguments) {
    command
        ->add_option("--set", arguments.changes, "Change a value of the scene: --set key.path=value; can be repeated")
        ->type_name("KEY=VALUE")
        ->check(assignment)
        ->allow_extra_args(false);
}

CLI::App* add_scene_command(CLI::App& program, const std::string& name, const std::string& what, Arguments& arguments) {
    CLI::App* command = program.add_subcommand(name, what);
    command->add_option("SCENE", arguments.scene, "Scene file")->required();
    add_changes(command, arguments);
    return command;
}

/// `surface-study` is an older name for studies of surfaces.
CLI::App* add_study_command(CLI::App& program, Arguments& arguments) {
    CLI::App* command = program.add_subcommand("study", "Measure error against run time over combinations of settings");
    command->alias("surface-study");
    command->add_option("STUDY", arguments.scene, "Study file");
    command->add_flag("--formulas", arguments.formulas, "List the formulas that studies may call");
    add_folder(command, arguments, "Folder of the tables and plots [out/<study name>]");
    const CLI::Range positive(1, 1024);
    command->add_option("--jobs", arguments.study.jobs, "Number of runs at the same time [1]")
        ->type_name("N")
        ->check(positive);
    command
        ->add_option("--threads", arguments.study.threads,
                     "Number of threads of every run [1]; of a study of surfaces [all]")
        ->type_name("N")
        ->check(positive);
    command->add_option("--repeats", arguments.study.repeats, "Number of times that every run is done [the study's]")
        ->type_name("N")
        ->check(positive);
    command
        ->add_option("--only", arguments.study.only,
                     "Run only these values of an axis: --only axis=value,value; can be repeated")
        ->type_name("AXIS=VALUES")
        ->check(assignment)
        ->allow_extra_args(false);
    command->add_flag("--report-only,--gather", arguments.study.report_only,
                      "Run nothing; write tables and plots again from the existing runs");
    command
        ->add_option("--emit", arguments.study.emit,
                     "Run nothing; write a Snakemake workflow or a SLURM array script that runs it elsewhere")
        ->type_name("snakemake|slurm")
        ->check(CLI::IsMember({"snakemake", "slurm"}));
    command->add_flag("--quiet", arguments.study.quiet, "Show no progress");
    add_changes(command, arguments);
    return command;
}

void add_run_options(CLI::App* run, Arguments& arguments) {
    run->add_option("--threads", arguments.threads, "Number of threads; results do not depend on it")
        ->type_name("N")
        ->check(CLI::Range(1, 1024));
    run->add_option("--checkpoint-every", arguments.checkpoint_every,
                    "Write a checkpoint each time a number of accepted steps ('20') or a time ('5 min') has passed")
        ->type_name("STEPS|TIME");
    run->add_flag("--quiet", arguments.quiet, "Show nothing but faults");
    run->add_flag("--distributed", arguments.distributed, "Share the run among the processes that mpirun has started");
}

CLI::Option* add_processes(CLI::App* command, Arguments& arguments, const std::string& what) {
    return command->add_option("--processes", arguments.processes, what)->type_name("N")->check(CLI::Range(1, 65536));
}

void show_run(const output::Summary& summary, const Arguments& arguments) {
    if (arguments.quiet) return;
    const std::string folder = summary.folder.string();
    const bool frames = std::ranges::count(summary.plan, "frames") > 0;
    print(fmt::format("{}: {} steps, {} Newton iterations, {:.1f} s; see {}{}/history.csv\n", summary.scene,
                      summary.steps.accepted, summary.iterations, summary.total_seconds,
                      frames ? folder + "/series.pvd and " : "", folder));
    if (summary.steps.at_round_off > 0)
        print(fmt::format("note: {} of these steps ended at the round-off of their forces and gaps, which is above "
                          "solver.tolerance\n",
                          summary.steps.at_round_off));
    if (summary.steps.held_geometry > 0)
        print(fmt::format(
            "note: {} of these steps found no solution while contact followed its facets and edges; they were "
            "solved with normals and places of contact held, to 1 % of a facet\n",
            summary.steps.held_geometry));
}

void run_study(Arguments arguments) {
    if (arguments.formulas) return print(formula_table());
    if (arguments.scene.empty()) {
        Fault fault;
        fault.file = "study";
        fault.expected = "a study file";
        fault.found = "none";
        throw SceneError({fault});
    }
    if (scene::is_run_study(arguments.scene)) {
        arguments.study.directory = arguments.output;
        arguments.study.overrides = arguments.overrides();
        arguments.study.folder = arguments.folder;
        print(run_study(arguments.scene, arguments.study));
        return;
    }
    if (!arguments.study.emit.empty()) {
        Fault fault;
        fault.file = "--emit";
        fault.expected = "a study of runs";
        fault.found = "'" + arguments.scene + "', a study of surfaces, which takes seconds";
        throw SceneError({fault});
    }
    const int threads = arguments.study.threads > 0 ? arguments.study.threads : arguments.threads;
    const scene::SurfaceStudy study = scene::read_surface_study(arguments.scene, study::method_names());
    output::OutputFolder files(
        chosen_folder(arguments.output.empty() ? "out/" + study.name : arguments.output, arguments.folder),
        entry_of(arguments.folder), surface_study_files(study));
    const std::string folder = files.path().string();
    show_numbered(arguments, folder);
    const std::string plots = write_surface_study(study, run_surface_study(study, threads), files);
    print(fmt::format("{}: see {}/study.md and study.csv; {}\n", study.name, folder, plots));
}

/// A scene that lacks physics of its deck is written only where that is allowed.
ExitCode import_scene(const Arguments& arguments) try {
    const deck::DeckUnits units = arguments.units == "mm" ? deck::DeckUnits::mm : deck::DeckUnits::si;
    const deck::ImportedScene scene = deck::import_deck(mesh::read_deck(arguments.deck), arguments.deck, units);
    for (const std::string& what : scene.notes) fmt::print(stderr, "{}\n", what);
    const bool refused = !scene.lost.empty() && !arguments.allow_loss;
    if (refused)
        fmt::print(stderr, "nothing is written, as the scene would lack these; --allow-loss writes it without them:\n");
    for (const std::string& what : scene.lost) fmt::print(stderr, "{}\n", what);
    if (refused) return lossy_import;
    print(scene.text);
    return done;
} catch (const mesh::MeshError& error) {
    throw mesh_faults(error, "deck");
}

ExitCode show_keys(const std::string& path) {
    const std::string keys = scene::describe_keys(path);
    if (keys.empty()) {
        fmt::print(stderr, "no key is called '{}'\n", path);
        return bad_scene;
    }
    print(keys);
    return done;
}

std::string schema(const std::string& kind) {
    if (kind == "study") return scene::study_schema(study::method_names());
    return kind == "template" ? scene::template_schema() : scene::scene_schema();
}

/// @param together  made where the command is one of several processes
ExitCode run_command(int argc, char** argv, std::optional<Distributed>& together) {
    Arguments arguments;
    CLI::App program("Deformable bodies in frictional contact on smooth surfaces.", "osculate");
    program.set_version_flag("--version", std::string("osculate ") + version);
    program.require_subcommand(1);
    CLI::App* run = add_scene_command(program, "run", "Run a scene", arguments);
    add_folder(run, arguments, "Folder of the run's files [out/<scene name>]");
    add_run_options(run, arguments);
    CLI::Option* emit =
        run->add_option("--emit", arguments.emit, "Run nothing; write a SLURM script that runs it elsewhere")
            ->type_name("slurm")
            ->check(CLI::IsMember({"slurm"}));
    add_processes(run, arguments, "Number of processes that the script starts [1]")->needs(emit);
    CLI::App* resume = program.add_subcommand("resume", "Continue a run from its last checkpoint");
    resume->add_option("DIR", arguments.run_folder, "Folder of the run's files")->required();
    resume->add_option("--from", arguments.from, "Start from this checkpoint instead of DIR/checkpoint/state")
        ->type_name("FILE");
    add_run_options(resume, arguments);
    CLI::App* check = add_scene_command(
        program, "check", "Validate a scene; show sizes, cost, pairs, initial gaps, and what looks wrong", arguments);
    CLI::App* explain = add_scene_command(program, "explain",
                                          "Show what a scene's plan contains, what it leaves out and why", arguments);
    for (CLI::App* command : {check, explain})
        add_processes(command, arguments, "Also show what each of so many processes would hold");
    CLI::App* surface = add_scene_command(
        program, "surface", "Write the master surfaces as the solver sees them, before any run", arguments);
    surface->add_option("--pair", arguments.surface.pair, "Only this contact pair")->type_name("NAME");
    add_folder(surface, arguments, "Folder of the files [out/<scene name>/surface]");
    surface->add_option("--refine", arguments.surface.refine, "Cut every facet into N x N cells [8]")
        ->type_name("N")
        ->check(CLI::Range(1, 1024));
    CLI::App* keys = program.add_subcommand("keys", "List the keys of a scene: unit, range, default, meaning");
    keys->add_option("PATH", arguments.key_path, "Only keys at or below this path");
    CLI::App* schemas =
        program.add_subcommand("schema", "Print the JSON Schema of scenes, studies or output templates, for editors");
    schemas->add_option("KIND", arguments.schema, "scene, study or template [scene]")
        ->check(CLI::IsMember({"scene", "study", "template"}));
    CLI::App* init = program.add_subcommand("init", "Write a commented scene to start from");
    init->add_option("TUTORIAL", arguments.scene, "Name of a tutorial; --list shows them");
    init->add_flag("--list", arguments.list, "List the tutorials");
    init->add_option("-o,--output", arguments.output, "The new scene file [TUTORIAL.yaml]")->type_name("FILE");
    check->add_flag("--json", arguments.json, "Print JSON, for programs");
    CLI::App* study = add_study_command(program, arguments);
    const std::vector<Command> results = add_result_commands(program);
    CLI::App* mesh = program.add_subcommand(
        "mesh", "Show what a mesh file or a geometry holds: sizes, parts, surfaces, node sets; solids, faces, edges");
    mesh->add_option("FILE", arguments.mesh.file, "Mesh file, or geometry: .step .stp .iges .igs .brep")->required();
    mesh->add_option("--picture", arguments.mesh.picture,
                     "Of a geometry: write a picture with the numbers of its faces")
        ->type_name("FILE.svg");
    mesh->add_option("--part", arguments.mesh.part, "Only this part")->type_name("NAME");
    mesh->add_option("--piece", arguments.mesh.piece, "Only this connected piece, counted from 1")
        ->type_name("N")
        ->check(CLI::PositiveNumber);
    CLI::App* import = program.add_subcommand("import", "Write an input deck of Abaqus or CalculiX as a scene");
    import->add_option("DECK", arguments.deck, "Input deck, .inp; the scene reads its mesh from it")->required();
    import
        ->add_option("--units", arguments.units,
                     "Units of the deck's numbers: si (m, kg, s) or mm (mm, t, s, so N and MPa) [si]")
        ->type_name("si|mm")
        ->check(CLI::IsMember({"si", "mm"}));
    import->add_flag("--allow-loss", arguments.allow_loss,
                     "Write the scene even if it lacks loads, contact, materials, supports or steps of the deck; "
                     "without this option, such a deck ends with exit code 5");
    std::vector<std::string> repairs = mesh::repair_words();
    repairs.emplace_back("all");
    mesh->add_option("--repair", arguments.mesh.repair, "Faults to repair, like `repair` in a scene")
        ->type_name("WORDS")
        ->delimiter(',')
        ->check(CLI::IsMember(repairs));
    try {
        program.parse(argc, argv);
    } catch (const CLI::ParseError& error) {
        if (const std::string words = mistyped(program); error.get_exit_code() != 0 && !words.empty()) {
            fmt::print(stderr, "{}", words);
            return bad_scene;
        }
        return program.exit(error) == 0 ? done : bad_scene; // --help and --version come this way too
    }

    for (const Command& command : results)
        if (*command.app) {
            command.act();
            return done;
        }
    if (*run && !arguments.emit.empty()) {
        print(write_run_script({arguments.scene, arguments.changes, arguments.output, arguments.checkpoint_every,
                                std::max(1, arguments.processes), arguments.threads},
                               arguments.overrides()));
        return done;
    }
    RunOptions options;
    if (*run || *resume) {
        options = arguments.run_options();
        if (arguments.distributed) {
            const Distributed& all = together.emplace();
            options.ranks = all.ranks();
            if (!all.first()) options.directory = all.scratch();
        }
    }
    if (*run) {
        options.entered = [&](const std::filesystem::path& folder) { show_numbered(arguments, folder); };
        show_run(app::run(arguments.scene, arguments.overrides(), options), arguments);
    } else if (*resume) {
        if (const auto summary = app::resume(arguments.run_folder, arguments.from, options))
            show_run(*summary, arguments);
        else if (!arguments.quiet)
            print(fmt::format("the run in {} is complete; there is nothing left to do\n", arguments.run_folder));
    } else if (*surface) {
        arguments.surface.directory = arguments.output;
        arguments.surface.threads = arguments.threads;
        arguments.surface.folder = arguments.folder;
        print(write_surfaces(arguments.scene, arguments.overrides(), arguments.surface));
    } else if (*study) {
        run_study(arguments);
    } else if (*keys) {
        return show_keys(arguments.key_path);
    } else if (*import) {
        return import_scene(arguments);
    } else if (*mesh) {
        print(describe_mesh(arguments.mesh));
    } else if (*schemas) {
        print(schema(arguments.schema));
    } else if (*init) {
        print(arguments.list ? tutorial_list() : init_scene(arguments.scene, arguments.output));
    } else {
        Timings unused;
        const LoadedScene loaded = load(arguments.scene, arguments.overrides(), arguments.threads, unused);
        if (*check)
            print(check_scene(loaded, arguments.threads, arguments.json, arguments.processes));
        else
            print(app::explain(loaded.plan) +
                  (arguments.processes > 0 ? processes_in_words(loaded.plan, arguments.processes) : ""));
    }
    return done;
}

} // namespace

namespace {

/// @param surprise  set for a failure that has nothing to do with the scene
int guarded_command(int argc, char** argv, std::optional<Distributed>& together, bool& surprise) {
    try {
        return run_command(argc, argv, together);
    } catch (const SceneError& error) {
        for (const Fault& fault : error.faults()) fmt::print(stderr, "{}\n", fault.message());
        return bad_scene;
    } catch (const ReportFailure& error) {
        fmt::print(stderr, "{}\n", error.what());
        return bad_scene;
    } catch (const Interrupted& error) {
        fmt::print(stderr, "{}\n", error.what());
        return 128 + error.signal(); // as shells report it
    } catch (const GaveUp& error) {
        fmt::print(stderr, "the run gave up: {}\n{}", error.what(), error.post_mortem());
        return gave_up;
    } catch (const RunFailure& error) {
        fmt::print(stderr, "the run gave up: {}\n", error.what());
        return gave_up;
    } catch (const std::filesystem::filesystem_error& error) { // a folder that is gone, or may not be read
        surprise = true;                                       // of one process alone, perhaps
        fmt::print(stderr, "{}: {}\n", error.path1().string(), error.code().message());
        return bad_scene;
    } catch (const std::bad_alloc&) {
        surprise = true;
        fmt::print(stderr, "the run gave up: there is not enough memory for a scene of this size\n");
        return gave_up;
    } catch (const std::exception& error) {
        fmt::print(stderr, "a bug in osculate {}, please report it with the scene: {}\n", version, error.what());
    } catch (...) {
        fmt::print(stderr, "a bug in osculate {}, please report it with the scene\n", version);
    }
    surprise = true;
    return bug;
}

} // namespace

int command_line(int argc, char** argv) {
    std::optional<Distributed> together;
    bool surprise = false;
    int code = guarded_command(argc, argv, together, surprise);
    if ((std::fflush(stdout) != 0 || std::ferror(stdout) != 0) && code == done) {
        fmt::print(stderr, "what there was to say could not be written\n");
        code = gave_up;
    }
    if (together) together->leave(code, surprise);
    return code;
}

} // namespace osculate::app
