#include "python/run_class.hpp"

#include "osculate/app/report.hpp"
#include "osculate/output/contact_resultants.hpp"
#include "osculate/output/fields.hpp"
#include "osculate/scene/nearest.hpp"
#include "python/arrays.hpp"
#include "python/scene_class.hpp"
#include "python/session.hpp"

#include <algorithm>
#include <limits>
#include <memory>
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>
#include <utility>

namespace osculate::python {

namespace py = pybind11;

namespace {

using output::FieldPlace;

/// A contact pair of a run.
struct PairOf {
    py::object run; ///< keeps the session
    Index index = -1;
};

constexpr std::chrono::milliseconds between_looks_at_signals{50};

[[noreturn]] void unknown(const std::string& what, const std::string& name, const std::vector<std::string>& known) {
    std::string text = "no " + what + " is called '" + name + "'";
    if (const std::string near = scene::nearest(name, known); !near.empty()) text += ", perhaps '" + near + "'";
    text += "; there are";
    for (const std::string& k : known) text += (k == known.front() ? " " : ", ") + k;
    throw py::key_error(text);
}

/// Place of the item called `name`. @throws KeyError with the names there are
template <class Items, class Name>
Index place(const Items& items, const std::string& what, const std::string& name, Name&& name_of) {
    std::vector<std::string> known;
    for (const auto& item : items) known.push_back(name_of(item));
    const auto at = std::ranges::find(known, name);
    if (at == known.end()) unknown(what, name, known);
    return static_cast<Index>(at - known.begin());
}

Index body_index(const Session& session, const std::string& name) {
    return place(session.model().bodies, "body", name, [](const model::Body& body) { return body.name; });
}

const model::Body& body(const Session& session, const std::string& name) {
    return session.model().bodies[static_cast<std::size_t>(body_index(session, name))];
}

void refuse_while_computing(const Session& session) {
    if (session.phase() == Session::Phase::running) throw std::runtime_error("the run is computing a step");
}

const output::Snapshot& snapshot(Session& session, bool reactions = false) {
    refuse_while_computing(session);
    const output::Snapshot* now = session.snapshot(reactions);
    if (now == nullptr)
        throw std::runtime_error(session.step().number == 0
                                     ? "no step has been taken yet"
                                     : "the run has ended within a step: of its last accepted step "
                                       "only displacements and contact forces are left");
    return *now;
}

/// Values of a field of the table of output, as frames hold them.
py::array field_values(Session& session, FieldPlace where, Index index, const std::string& name) {
    std::vector<std::string> known;
    for (const output::OutputField& field : output::all_fields())
        if (field.where == where) known.emplace_back(field.name);
    if (std::ranges::count(known, name) == 0) unknown("field", name, known);
    const output::Array array =
        output::evaluate(output::field(where, name), snapshot(session, name == "reaction"), index);
    if (!array.integer) return owned(array.values, array.components);
    return owned(std::vector<std::int32_t>(array.values.begin(), array.values.end()));
}

py::array nodal(const py::object& self, const std::string& name, const std::vector<Vec3>& values) {
    const auto& session = self.cast<const Session&>();
    const model::Body& of = body(session, name);
    if (values.empty()) throw std::runtime_error("no stage with dynamics has begun");
    return view(
        std::span(values).subspan(static_cast<std::size_t>(of.first_node), static_cast<std::size_t>(of.nodes())), self);
}

py::array nodes(const py::object& self, const std::string& name) {
    const auto& session = self.cast<const Session&>();
    const std::vector<Vec3>& points = body(session, name).mesh.nodes;
    if (session.model().origin.isZero(0)) return view(std::span(points), self);
    std::vector<double> moved;
    for (const Vec3& X : points)
        for (int k = 0; k < 3; ++k) moved.push_back(X(k) + session.model().origin(k));
    return owned(std::move(moved), 3);
}

py::list cells(const py::object& self, const std::string& name) {
    py::list blocks;
    for (const mesh::ElementBlock& block : body(self.cast<const Session&>(), name).mesh.blocks)
        blocks.append(py::make_tuple(std::string(mesh::cell_info(block.type).meshio),
                                     view(std::span(block.connectivity), mesh::nodes_per_cell(block.type), self)));
    return blocks;
}

/// Numbers of nodes within their body.
py::array within(const model::Model& model, const model::Body& of, const std::vector<Index>& global) {
    std::vector<std::int32_t> numbers;
    for (const Index node : global) numbers.push_back(model::material_node(model, node) - of.first_node);
    return owned(std::move(numbers));
}

py::tuple set_nodes(const Session& session, const std::string& name) {
    const std::vector<model::Set>& sets = session.model().sets;
    const Index at = place(sets, "set", name, [](const model::Set& set) { return set.name; });
    const model::Set& set = sets[static_cast<std::size_t>(at)];
    const model::Body& of = session.model().bodies[static_cast<std::size_t>(set.body)];
    return py::make_tuple(of.name, within(session.model(), of, set.nodes));
}

py::dict history(const Session& session) {
    refuse_while_computing(session);
    py::dict columns;
    for (std::size_t c = 0; c < session.history_columns().size(); ++c) {
        std::vector<double> values;
        for (const std::vector<output::Cell>& row : session.history()) {
            const output::Cell& cell = row[c];
            values.push_back(std::holds_alternative<double>(cell) ? std::get<double>(cell)
                             : std::holds_alternative<long>(cell) ? static_cast<double>(std::get<long>(cell))
                                                                  : std::numeric_limits<double>::quiet_NaN());
        }
        columns[py::str(session.history_columns()[c])] = owned(std::move(values), 1);
    }
    return columns;
}

/// Waits for the run as long as it computes. A signal of Python, such as Ctrl-C, is heeded after the present attempt.
void wait(Session& session) {
    const auto computes = [&] {
        const py::gil_scoped_release others;
        return !session.wait(between_looks_at_signals);
    };
    while (computes()) {
        if (PyErr_CheckSignals() == 0) continue;
        py::error_already_set interruption; // takes it, and puts it back when thrown
        session.pause();
        while (computes()) {
        }
        throw interruption;
    }
}

/// The next accepted step; nothing where the run has ended. An interruption leaves the run where it can go on.
std::optional<Session::Step> next(Session& session) {
    refuse_while_computing(session);
    if (PyErr_CheckSignals() != 0) throw py::error_already_set();
    if (!session.has_news()) {
        session.go_on();
        wait(session);
    }
    if (session.has_news()) return session.hand_out();
    if (const std::exception_ptr failure = session.take_failure()) std::rethrow_exception(failure);
    return std::nullopt;
}

void close(Session& session) {
    const py::gil_scoped_release others;
    session.close();
}

void run_all(Session& run, const py::object& on_step) {
    try {
        while (const auto step = next(run))
            if (!on_step.is_none()) on_step(py::cast(*step));
    } catch (...) {
        close(run);
        throw;
    }
}

std::unique_ptr<Session> make_run(const SceneFile& file, int threads) {
    if (threads < 1) throw py::value_error("threads: expected 1 or more, found " + std::to_string(threads));
    const py::gil_scoped_release others;
    if (file.path.empty()) return std::make_unique<Session>(file.scene, threads);
    return std::make_unique<Session>(file.path, file.overrides, threads);
}

void write(Session& run, const std::filesystem::path& folder, const py::object& checkpoint_every, bool force) {
    if (run.phase() != Session::Phase::created)
        throw std::runtime_error("files are written from the start: call write() before the first step");
    app::RunOptions options;
    options.directory = folder;
    options.threads = run.threads();
    options.quiet = true;
    if (!checkpoint_every.is_none()) options.checkpoint_every = app::parse_checkpoint_every(py::str(checkpoint_every));
    options.folder.force = force;
    run.write(std::move(options));
}

Session& session_of(const PairOf& pair) {
    return pair.run.cast<Session&>();
}

const model::ContactPair& pair_of(const PairOf& pair) {
    return *session_of(pair).model().pairs[static_cast<std::size_t>(pair.index)];
}

output::ContactResultants resultants(const PairOf& pair) {
    return output::contact_resultants(snapshot(session_of(pair)), pair.index);
}

std::vector<double> areas(const PairOf& pair) {
    const output::Snapshot& at = snapshot(session_of(pair));
    std::vector<double> all;
    for (Index j = 0; j < pair_of(pair).size(); ++j) all.push_back(at.evaluation(pair.index).area(j));
    return all;
}

/// Body of the slave nodes, and their numbers within it.
py::tuple slave_nodes(const PairOf& pair) {
    const std::vector<Index>& global = pair_of(pair).slaves().node;
    const model::Model& model = session_of(pair).model();
    if (const model::Body* of = global.empty() ? nullptr : model::body_of(model, global.front()); of != nullptr)
        return py::make_tuple(of->name, within(model, *of, global));
    return py::make_tuple(py::none(), owned(std::vector<std::int32_t>{}));
}

void add_pair(py::module_& module) {
    py::class_<PairOf> pair(module, "Pair",
                            "A contact pair of a run, at its last accepted step. Arrays have a row per slave node.");
    pair.def_property_readonly("name", [](const PairOf& p) { return pair_of(p).name(); })
        .def_property_readonly("nodes", slave_nodes, "(body, numbers of the slave nodes within it)")
        .def_property_readonly(
            "area", [](const PairOf& p) { return owned(areas(p), 1); },
            "(n) m^2, that the force on each slave node presses on, in the reference configuration")
        .def_property_readonly(
            "contact_force",
            [](const PairOf& p) {
                const auto& history = session_of(p).state().contact[static_cast<std::size_t>(p.index)];
                return view(std::span(history.lambda), p.run);
            },
            "(n, 3) N, on each slave node; a view of the run's own memory, which follows the run")
        .def_property_readonly(
            "force", [](const PairOf& p) { return owned(resultants(p).force); }, "(3) N, resultant on the slave")
        .def_property_readonly(
            "moment", [](const PairOf& p) { return owned(resultants(p).moment); }, "(3) N m, about the origin")
        .def_property_readonly(
            "normal_force", [](const PairOf& p) { return resultants(p).normal; }, "N, sum over the nodes")
        .def_property_readonly(
            "friction_force", [](const PairOf& p) { return resultants(p).friction; }, "N, sum over the nodes")
        .def(
            "field",
            [](const PairOf& p, const std::string& name) {
                return field_values(session_of(p), FieldPlace::slave, p.index, name);
            },
            py::arg("name"), "Field of the slave nodes by its name in frames.")
        .def(
            "master_field",
            [](const PairOf& p, const std::string& name) {
                return field_values(session_of(p), FieldPlace::master, p.index, name);
            },
            py::arg("name"), "Field of the master's vertices by its name in frames.")
        .def("__repr__", [](const PairOf& p) { return "<osculate.Pair '" + pair_of(p).name() + "'>"; });
    for (const auto& [name, doc] :
         {std::pair{"gap", "(n) m, < 0 where it is passed; NaN without a partner"},
          std::pair{"status", "(n) 0 open, 1 stick, 2 slip"},
          std::pair{"normal", "(n, 3) out of the master; 0 without a partner"},
          std::pair{"normal_stress", "(n) Pa, > 0 in compression"}, std::pair{"slip", "(n, 3) m, of the step"}})
        pair.def_property_readonly(name, py::cpp_function([name](const PairOf& p) {
                                       return field_values(session_of(p), FieldPlace::slave, p.index, name);
                                   }),
                                   doc);
}

} // namespace

void add_run(py::module_& module) {
    py::class_<Session::Step>(module, "Step", "An accepted step.")
        .def_readonly("number", &Session::Step::number, "from 1")
        .def_readonly("time", &Session::Step::time, "s, at its end")
        .def_readonly("dt", &Session::Step::dt, "s")
        .def_readonly("iterations", &Session::Step::iterations, "of Newton's method")
        .def_readonly("stage", &Session::Step::stage)
        .def("__repr__", [](const Session::Step& s) {
            return py::str("<osculate.Step {} of stage '{}', time {} s, dt {} s, {} iterations>")
                .format(s.number, s.stage, s.time, s.dt, s.iterations);
        });
    add_pair(module);

    py::class_<Session> run(module, "Run", R"(A scene compiled and taken step by step.

    for step in run: ...        one accepted step after another
    run.run(on_step)            the same with a function of the step

A step is computed on a thread of the run's own without the interpreter's lock, and the run waits while it is looked at.
Ctrl-C is heeded after the attempt that is computed: KeyboardInterrupt leaves the run where it can go on. Arrays are read
only. Those said to be views are the run's own memory: they change as it goes on, .copy() keeps a state.)");
    run.def(py::init(&make_run), py::arg("scene"), py::arg("threads") = 1,
            "Compiles a scene. Results do not depend on the number of threads.\n\nRaises SceneError with all faults.")
        .def(py::init([](const std::filesystem::path& path, const py::dict& overrides, int threads) {
                 return make_run(SceneFile::read(path.string(), overrides), threads);
             }),
             py::arg("path"), py::arg("overrides") = py::dict(), py::arg("threads") = 1)
        .def("__iter__", [](py::object self) { return self; })
        .def("__next__",
             [](Session& self) {
                 if (const auto step = next(self)) return *step;
                 throw py::stop_iteration();
             })
        .def("run", run_all, py::arg("on_step") = py::none(),
             "Takes all steps that are left; what `on_step` raises ends the run and comes out.\n\nRaises RunFailure.")
        .def("write", write, py::arg("folder"), py::arg("checkpoint_every") = py::none(), py::arg("force") = false,
             "Has the run write the files of `osculate run` while it goes. To be called before the first step. The "
             "folder "
             "is absent, empty or that of an earlier run; `force`: whatever is in it, as --force does.")
        .def("close", close, "Ends the run where it is; `for` and run() then find no more steps.")
        .def("__enter__", [](py::object self) { return self; })
        .def("__exit__", [](Session& self, const py::args&) { close(self); })
        .def_property_readonly("bodies",
                               [](const Session& self) {
                                   std::vector<std::string> names;
                                   for (const model::Body& b : self.model().bodies) names.push_back(b.name);
                                   return names;
                               })
        .def_property_readonly("pairs",
                               [](const Session& self) {
                                   std::vector<std::string> names;
                                   for (const auto& p : self.model().pairs) names.push_back(p->name());
                                   return names;
                               })
        .def_property_readonly(
            "time", [](const Session& self) { return self.state().time; }, "s, of the last accepted step")
        .def_property_readonly("completed", &Session::completed)
        .def_property_readonly("rejected", &Session::rejected, "attempts at steps that were rejected")
        .def_property_readonly("history", &history,
                               "Columns of history.csv by name, a value per accepted step; NaN for empty cells.")
        .def("nodes", &nodes, py::arg("body"), "(n, 3) reference positions, m; a view")
        .def("cells", &cells, py::arg("body"), "[(type, (m, k) node numbers)], types as meshio names them; views")
        .def("set", &set_nodes, py::arg("name"), "(body, numbers of the set's nodes within it)")
        .def(
            "displacement",
            [](const py::object& self, const std::string& name) {
                return nodal(self, name, self.cast<const Session&>().state().u);
            },
            py::arg("body"), "(n, 3) m; a view of the run's own memory, which follows the run")
        .def(
            "velocity",
            [](const py::object& self, const std::string& name) {
                return nodal(self, name, self.cast<const Session&>().state().v);
            },
            py::arg("body"), "(n, 3) m/s; a view, from the first stage with dynamics on")
        .def(
            "acceleration",
            [](const py::object& self, const std::string& name) {
                return nodal(self, name, self.cast<const Session&>().state().a);
            },
            py::arg("body"), "(n, 3) m/s^2; a view, from the first stage with dynamics on")
        .def(
            "field",
            [](Session& self, const std::string& name, const std::string& field) {
                return field_values(self, FieldPlace::body, body_index(self, name), field);
            },
            py::arg("body"), py::arg("name"), "Field of a body's nodes by its name in frames.")
        .def(
            "pair",
            [](const py::object& self, const std::string& name) {
                const Index at = place(self.cast<const Session&>().model().pairs, "pair", name,
                                       [](const auto& p) { return p->name(); });
                return PairOf{self, at};
            },
            py::arg("name"))
        .def_property_readonly(
            "explain", [](const Session& self) { return app::explain(self.loaded().plan); },
            "What the run holds, what is left out and why.")
        .def("__repr__", [](const Session& self) {
            return py::str("<osculate.Run of '{}', {} steps, time {} s>")
                .format(self.loaded().scene.name, self.step().number, self.state().time);
        });
    for (const auto& [name, doc] : {std::pair{"stress", "(n, 6) Pa: xx, yy, zz, xy, yz, zx"},
                                    std::pair{"von_mises", "(n) Pa"}, std::pair{"reaction", "(n, 3) N"}})
        run.def(
            name,
            [name](Session& self, const std::string& body) {
                return field_values(self, FieldPlace::body, body_index(self, body), name);
            },
            py::arg("body"), doc);
}

} // namespace osculate::python
