// SPDX-License-Identifier: Apache-2.0
// A library that stands between a program and Oclgrind (scripts/oclgrind). It must be loaded first
// (LD_PRELOAD).
//
// Threads that compile or run kernels at the same time share Oclgrind's LLVM without a lock, and its notes on
// memory belong to the thread that makes the context. The library therefore has one thread make all calls
// that compile, run, write and read.
//
// Variables of the environment:
// - NEARLIGHT_OCLGRIND_CPU: if it is set, the device says that it is a CPU, and otherwise, as Oclgrind does,
//   that it is everything.
// - NEARLIGHT_OCLGRIND_REPORT: a file to which the name of each kernel is added when it first runs.
#include <CL/cl.h>
#include <dlfcn.h>
#include <unistd.h>

#include <condition_variable>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <functional>
#include <future>
#include <map>
#include <mutex>
#include <queue>
#include <set>
#include <string>
#include <thread>

#define NEARLIGHT_EXPORTED extern "C" __attribute__((visibility("default")))

namespace {

/// The function that would be called without this library.
template <typename Function>
Function* next(const char* name) {
    return reinterpret_cast<Function*>(dlsym(RTLD_NEXT, name));
}
#define NEXT(function) next<decltype(function)>(#function)

/// A thread that runs one action after another.
class Servant {
  public:
    /// Runs an action and waits for it.
    template <typename Action>
    auto run(Action action) {
        if (std::this_thread::get_id() == thread_.get_id()) {
            return action();
        }
        std::packaged_task<decltype(action())()> task(action);
        auto result = task.get_future();
        {
            const std::lock_guard lock(mutex_);
            tasks_.push([&task] { task(); });
        }
        wake_.notify_one();
        return result.get();
    }

  private:
    [[noreturn]] void serve() {
        while (true) {
            std::unique_lock lock(mutex_);
            wake_.wait(lock, [this] { return !tasks_.empty(); });
            const std::function<void()> task = std::move(tasks_.front());
            tasks_.pop();
            lock.unlock();
            task();
        }
    }

    std::mutex mutex_;
    std::condition_variable wake_;
    std::queue<std::function<void()>> tasks_;
    std::thread thread_{[this] { serve(); }};
};

/// The servant of this process, which lives as long as it does. A forked process gets another.
Servant& servant() {
    static std::mutex mutex;
    static std::map<pid_t, Servant*> servants;
    const std::lock_guard lock(mutex);
    Servant*& mine = servants[getpid()];
    if (mine == nullptr) {
        mine = new Servant;
    }
    return *mine;
}

void report(cl_kernel kernel) {
    const char* const file = std::getenv("NEARLIGHT_OCLGRIND_REPORT");
    size_t size = 0;
    if (file == nullptr ||
        clGetKernelInfo(kernel, CL_KERNEL_FUNCTION_NAME, 0, nullptr, &size) != CL_SUCCESS) {
        return;
    }
    std::string name(size, '\0');
    clGetKernelInfo(kernel, CL_KERNEL_FUNCTION_NAME, size, name.data(), nullptr);
    name.resize(std::strlen(name.c_str()));
    static std::set<std::string> known;
    if (known.insert(name).second) {
        std::ofstream(file, std::ios::app) << name << '\n';
    }
}

}  // namespace

NEARLIGHT_EXPORTED cl_int clEnqueueWriteBuffer(cl_command_queue queue, cl_mem buffer, cl_bool blocking,
                                               size_t offset, size_t size, const void* data,
                                               cl_uint wait_count, const cl_event* waits, cl_event* event) {
    return servant().run([&] {
        return NEXT(clEnqueueWriteBuffer)(queue, buffer, blocking, offset, size, data, wait_count, waits,
                                          event);
    });
}

NEARLIGHT_EXPORTED cl_int clEnqueueFillBuffer(cl_command_queue queue, cl_mem buffer, const void* pattern,
                                              size_t pattern_size, size_t offset, size_t size,
                                              cl_uint wait_count, const cl_event* waits, cl_event* event) {
    return servant().run([&] {
        return NEXT(clEnqueueFillBuffer)(queue, buffer, pattern, pattern_size, offset, size, wait_count,
                                         waits, event);
    });
}

NEARLIGHT_EXPORTED cl_int clReleaseMemObject(cl_mem object) {
    return servant().run([&] { return NEXT(clReleaseMemObject)(object); });
}

NEARLIGHT_EXPORTED cl_int clGetDeviceInfo(cl_device_id device, cl_device_info parameter, size_t size,
                                          void* value, size_t* size_needed) {
    const cl_int error = NEXT(clGetDeviceInfo)(device, parameter, size, value, size_needed);
    if (error == CL_SUCCESS && parameter == CL_DEVICE_TYPE && value != nullptr &&
        std::getenv("NEARLIGHT_OCLGRIND_CPU") != nullptr) {
        *static_cast<cl_device_type*>(value) = CL_DEVICE_TYPE_CPU;
    }
    return error;
}

NEARLIGHT_EXPORTED cl_int clEnqueueNDRangeKernel(cl_command_queue queue, cl_kernel kernel, cl_uint dimensions,
                                                 const size_t* offset, const size_t* global,
                                                 const size_t* local, cl_uint wait_count,
                                                 const cl_event* waits, cl_event* event) {
    return servant().run([&] {
        report(kernel);
        return NEXT(clEnqueueNDRangeKernel)(queue, kernel, dimensions, offset, global, local, wait_count,
                                            waits, event);
    });
}

NEARLIGHT_EXPORTED cl_int clBuildProgram(cl_program program, cl_uint device_count,
                                         const cl_device_id* devices, const char* options,
                                         void(CL_CALLBACK* done)(cl_program, void*), void* user_data) {
    return servant().run(
        [&] { return NEXT(clBuildProgram)(program, device_count, devices, options, done, user_data); });
}

NEARLIGHT_EXPORTED cl_kernel clCreateKernel(cl_program program, const char* name, cl_int* error) {
    return servant().run([&] { return NEXT(clCreateKernel)(program, name, error); });
}

NEARLIGHT_EXPORTED cl_int clEnqueueReadBuffer(cl_command_queue queue, cl_mem buffer, cl_bool blocking,
                                              size_t offset, size_t size, void* data, cl_uint wait_count,
                                              const cl_event* waits, cl_event* event) {
    return servant().run([&] {
        return NEXT(clEnqueueReadBuffer)(queue, buffer, blocking, offset, size, data, wait_count, waits,
                                         event);
    });
}

NEARLIGHT_EXPORTED cl_int clWaitForEvents(cl_uint count, const cl_event* events) {
    return servant().run([&] { return NEXT(clWaitForEvents)(count, events); });
}

NEARLIGHT_EXPORTED cl_int clFlush(cl_command_queue queue) {
    return servant().run([&] { return NEXT(clFlush)(queue); });
}

NEARLIGHT_EXPORTED cl_int clFinish(cl_command_queue queue) {
    return servant().run([&] { return NEXT(clFinish)(queue); });
}

NEARLIGHT_EXPORTED cl_program clCreateProgramWithBinary(cl_context context, cl_uint device_count,
                                                        const cl_device_id* devices, const size_t* sizes,
                                                        const unsigned char** binaries, cl_int* status,
                                                        cl_int* error) {
    return servant().run([&] {
        return NEXT(clCreateProgramWithBinary)(context, device_count, devices, sizes, binaries, status,
                                               error);
    });
}

NEARLIGHT_EXPORTED cl_int clGetProgramInfo(cl_program program, cl_program_info parameter, size_t size,
                                           void* value, size_t* size_needed) {
    return servant().run(
        [&] { return NEXT(clGetProgramInfo)(program, parameter, size, value, size_needed); });
}

NEARLIGHT_EXPORTED cl_int clReleaseProgram(cl_program program) {
    return servant().run([&] { return NEXT(clReleaseProgram)(program); });
}

NEARLIGHT_EXPORTED cl_int clReleaseKernel(cl_kernel kernel) {
    return servant().run([&] { return NEXT(clReleaseKernel)(kernel); });
}

NEARLIGHT_EXPORTED cl_context clCreateContext(
    const cl_context_properties* properties, cl_uint device_count, const cl_device_id* devices,
    void(CL_CALLBACK* notify)(const char*, const void*, size_t, void*), void* user_data, cl_int* error) {
    return servant().run(
        [&] { return NEXT(clCreateContext)(properties, device_count, devices, notify, user_data, error); });
}
