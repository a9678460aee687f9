#include "osculate/app/command_line.hpp"

#ifdef __GLIBC__
#include <malloc.h>
#endif

int main(int argc, char** argv) {
#ifdef __GLIBC__
    // a solve asks for the same few megabytes again and again: given back each time, they cost half of a run in page faults
    mallopt(M_MMAP_THRESHOLD, 32 << 20);
    mallopt(M_TRIM_THRESHOLD, 256 << 20);
#endif
    return osculate::app::command_line(argc, argv);
}
