#include "osculate/app/command_line.hpp"

int main(int argc, char** argv) {
    return osculate::app::command_line(argc, argv);
}
