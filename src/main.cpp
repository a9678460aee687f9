#include "osculate/app/compile.hpp"
#include "osculate/core/error.hpp"
#include "osculate/scene/reader.hpp"

#include <cstdio>
#include <cstring>
using namespace osculate;
struct Obs : time::StepObserver {
    bool verbose = false;
    void attempted(const time::Attempt& a, const std::vector<time::IterationRecord>& its) override {
        printf("attempt %d t=%g dt=%g %s it=%d %s\n", a.attempt, a.time, a.dt, name(a.verdict).c_str(), a.iterations,
               a.cause.c_str());
        if (verbose || a.verdict != time::Verdict::accept)
            for (auto& r : its)
                printf("   %d res %.3e changes %d open %d stick %d slip %d facets %d\n", r.iteration, r.residual,
                       r.status_changes, r.open, r.stick, r.slip, r.facet_changes);
        fflush(stdout);
    }
    model::Model* m;
    void accepted(const time::AcceptedStep& s) override {
        for (size_t p = 0; p < m->pairs.size(); ++p) {
            Vec3 F = Vec3::Zero();
            double N = 0, T = 0;
            for (Index j = 0; j < m->pairs[p]->size(); ++j) {
                Vec3 l = s.state.contact[p].lambda[j];
                F += l;
                Vec3 n = m->pairs[p]->point(j).normal;
                N += l.dot(n);
                T += (l - n * n.dot(l)).norm();
            }
            printf("   N %.6g T %.6g F %.6g %.8g %.6g\n", N, T, F.x(), F.y(), F.z());
        }
    }
};
int main(int argc, char** argv) {
    std::vector<scene::Override> o;
    bool v = false;
    for (int i = 2; i < argc; ++i) {
        if (!strcmp(argv[i], "-v")) {
            v = true;
            continue;
        }
        std::string s = argv[i];
        auto e = s.find('=');
        o.push_back({s.substr(0, e), s.substr(e + 1)});
    }
    Timings t;
    try {
        auto sc = scene::read_scene(argv[1], o);
        auto plan = app::compile(sc, app::build_meshes(sc), 1, t);
        time::Stepper st(plan.model, plan.stages, plan.stepper, t);
        Obs ob;
        ob.m = &plan.model;
        ob.verbose = v;
        st.run(ob);
        printf("factorisations %ld\n", st.factorisations());
    } catch (const std::exception& e) {
        puts(e.what());
    }
    const char* n[] = {"search", "patches", "contact", "assembly", "factor", "solve", "output"};
    for (int i = 0; i < 7; ++i) printf("%s %.3f\n", n[i], t[(Part)i]);
}
