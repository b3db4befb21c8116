// SPDX-License-Identifier: Apache-2.0
#include "host/scene/note_sink.h"

#include "host/base/message.h"
#include "nearlight/error.h"

namespace nearlight::core {

void NoteSink::approximation(const std::filesystem::path& file, int line, const std::string& text) {
    if (strict_) {
        throw Error(ErrorKind::file,
                    to_string(Note{file, line, text}) + " (an error because loading is strict)", "strict");
    }
    remark(file, line, text);
}

void NoteSink::remark(const std::filesystem::path& file, int line, const std::string& text) {
    if (said_.insert(text).second) {
        say_warning(to_string(notes_.emplace_back(Note{file, line, text})));
    }
}

}  // namespace nearlight::core
