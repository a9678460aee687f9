#include "solve/sliced_vector.hpp"

#include "osculate/core/error.hpp"

#include <cstdlib>
#include <nvector/nvector_serial.h>
#include <span>

namespace osculate::solve {
namespace {

/// Begins as serial vectors do, whose operations read no further.
struct Content {
    _N_VectorContent_Serial slice;
    Ranks* ranks;
};

Ranks& ranks_of(N_Vector v) {
    return *static_cast<Content*>(v->content)->ranks;
}

/// Gives a serial vector its processes. Its own operations free the content by free().
void join(N_Vector serial, Ranks& ranks) {
    auto* content = static_cast<Content*>(std::malloc(sizeof(Content)));
    require(content != nullptr, "no memory for a vector");
    content->slice = *static_cast<N_VectorContent_Serial>(serial->content);
    content->ranks = &ranks;
    std::free(serial->content);
    serial->content = content;
}

N_Vector clone(N_Vector of) {
    N_Vector v = N_VClone_Serial(of);
    if (v != nullptr) join(v, ranks_of(of));
    return v;
}

double dot(N_Vector a, N_Vector b) {
    double product = N_VDotProd_Serial(a, b);
    ranks_of(a).sum({&product, 1});
    return product;
}

int dots(int count, N_Vector a, N_Vector* with, double* products) {
    const int status = N_VDotProdMulti_Serial(count, a, with, products);
    ranks_of(a).sum({products, static_cast<std::size_t>(count)});
    return status;
}

} // namespace

N_Vector make_sliced(Index length, Ranks& ranks, SUNContext context) {
    N_Vector v = N_VNew_Serial(length, context);
    require(v != nullptr, "no memory for a vector");
    join(v, ranks);
    N_VEnableFusedOps_Serial(v, SUNTRUE);
    v->ops->nvclone = clone;
    v->ops->nvdotprod = dot;
    v->ops->nvdotprodmulti = dots;
    return v;
}

} // namespace osculate::solve
