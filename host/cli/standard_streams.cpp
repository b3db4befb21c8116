// SPDX-License-Identifier: Apache-2.0
#include "host/cli/standard_streams.h"

#include <fcntl.h>
#include <unistd.h>

#include <csignal>

namespace nearlight::core {

void prepare_standard_streams() {
    int file = 0;
    while (file >= 0 && file <= STDERR_FILENO) {  // open() takes the lowest number that is free
        file = open("/dev/null", O_RDWR);
    }
    if (file >= 0) {
        close(file);
    }
    std::signal(SIGPIPE, SIG_IGN);
    std::signal(SIGXFSZ, SIG_IGN);
}

}  // namespace nearlight::core
