// SPDX-License-Identifier: Apache-2.0
// A library that stands between a program and the OpenCL loader, and makes a call fail. It must be loaded
// first (LD_PRELOAD). It forwards the calls that nearlight makes. Variables of the environment, which all
// have the prefix NEARLIGHT_FAULT_, say what it does:
// - CALL: which call fails, counted from 1 over all threads of the process.
// - KIND: the entry point whose calls are counted, such as clCreateBuffer. All are if it is not set.
// - CODE: the error code. It is CL_OUT_OF_RESOURCES if it is not set.
// - MODE: with `once` one call fails. With `lost`, all calls fail from then on that concern its device.
//   With `late`, a command that was to fail is accepted and never runs, and the device is lost. With `abort`
//   the call ends the process, as drivers do.
// - CHILDREN: if it is set, calls are counted in the processes that the program forks, and not in its own.
// - REPORT: a file to which the entry point of each counted call is added, one per line.
#include "tests/faults/failing_opencl.h"

#include <CL/cl.h>
#include <dlfcn.h>
#include <unistd.h>

#include <cstdlib>
#include <fstream>
#include <map>
#include <mutex>
#include <string>
#include <string_view>

#define NEARLIGHT_EXPORTED extern "C" __attribute__((visibility("default")))

namespace {

std::string variable(const char* name) {
    const char* const value = std::getenv(name);
    return value == nullptr ? "" : value;
}

enum class Fate { runs, fails, vanishes };

/// Counts the calls of a process and decides their fate.
class Faults {
  public:
    /// `subject` is the handle that the call concerns, or null.
    Fate next(std::string_view entry_point, const void* subject) {
        const std::lock_guard lock(mutex_);
        if ((getpid() != owner_) != in_children_) {
            return Fate::runs;
        }
        const void* const device = device_of(subject);
        if (is_lost_ && device == lost_ && !entry_point.starts_with("clRelease")) {
            return Fate::fails;
        }
        if (!kind_.empty() && entry_point != kind_) {
            return Fate::runs;
        }
        report_ << entry_point << '\n' << std::flush;
        if (++count_ != call_) {
            return Fate::runs;
        }
        if (mode_ == "abort") {
            std::abort();
        }
        is_lost_ = mode_ != "once" && device != nullptr;
        lost_ = device;
        const bool is_command =
            entry_point == "clEnqueueNDRangeKernel" || entry_point == "clEnqueueFillBuffer";
        return mode_ == "late" && is_command ? Fate::vanishes : Fate::fails;
    }
    /// Notes that a new handle belongs to the device of another one.
    void adopt(const void* handle, const void* parent) {
        const std::lock_guard lock(mutex_);
        if (handle != nullptr) {
            devices_[handle] = device_of(parent);
        }
    }
    [[nodiscard]] cl_int code() const { return code_; }
    /// Counts from 0 again, until `call` fails once with `code`.
    void begin(long call, cl_int code) {
        const std::lock_guard lock(mutex_);
        call_ = call;
        code_ = code;
        count_ = 0;
    }
    [[nodiscard]] long count() {
        const std::lock_guard lock(mutex_);
        return count_;
    }

  private:
    /// A handle that nothing is noted of is a device itself.
    [[nodiscard]] const void* device_of(const void* handle) const {
        const auto found = devices_.find(handle);
        return found == devices_.end() ? handle : found->second;
    }

    const pid_t owner_ = getpid();
    const bool in_children_ = !variable("NEARLIGHT_FAULT_CHILDREN").empty();
    const std::string kind_ = variable("NEARLIGHT_FAULT_KIND");
    const std::string mode_ =
        variable("NEARLIGHT_FAULT_MODE").empty() ? "once" : variable("NEARLIGHT_FAULT_MODE");
    long call_ = std::atol(variable("NEARLIGHT_FAULT_CALL").c_str());
    cl_int code_ = variable("NEARLIGHT_FAULT_CODE").empty()
                       ? CL_OUT_OF_RESOURCES
                       : std::atoi(variable("NEARLIGHT_FAULT_CODE").c_str());
    std::ofstream report_{variable("NEARLIGHT_FAULT_REPORT"), std::ios::app};
    std::mutex mutex_;
    std::map<const void*, const void*> devices_;
    long count_ = 0;
    bool is_lost_ = false;
    const void* lost_ = nullptr;
};

/// It is never destroyed, because the program's own static objects may still call OpenCL.
Faults& faults() {
    static Faults& instance = *new Faults;
    return instance;
}

// Processes that the program forks must find that they are not the one that loaded the library.
[[maybe_unused]] Faults& loaded = faults();

template <typename Function>
Function* forwarded(Function&, const char* name) {
    return reinterpret_cast<Function*>(dlsym(RTLD_NEXT, name));
}

}  // namespace

void nearlight_fault(long call, int code) {
    faults().begin(call, code);
}

long nearlight_fault_calls() {
    return faults().count();
}

/// An entry point that returns a status.
#define NEARLIGHT_STATUS(name, subject, parameters, arguments)                                   \
    NEARLIGHT_EXPORTED cl_int name parameters {                                                  \
        static auto* const driver = forwarded(name, #name);                                      \
        return faults().next(#name, subject) == Fate::runs ? driver arguments : faults().code(); \
    }

/// An entry point that returns a new handle and, through its parameter `status`, a status.
#define NEARLIGHT_HANDLE(Handle, name, subject, parameters, arguments) \
    NEARLIGHT_EXPORTED Handle name parameters {                        \
        static auto* const driver = forwarded(name, #name);            \
        if (faults().next(#name, subject) != Fate::runs) {             \
            if (status != nullptr) {                                   \
                *status = faults().code();                             \
            }                                                          \
            return nullptr;                                            \
        }                                                              \
        const Handle handle = driver arguments;                        \
        faults().adopt(handle, subject);                               \
        return handle;                                                 \
    }

/// An entry point that retains or releases a handle.
#define NEARLIGHT_COUNTED(name, Handle) NEARLIGHT_STATUS(name, handle, (Handle handle), (handle))

/// An entry point that tells a property of a handle.
#define NEARLIGHT_INFO(name, Handle, Property)                                                             \
    NEARLIGHT_STATUS(name, handle,                                                                         \
                     (Handle handle, Property property, std::size_t size, void* value, std::size_t* need), \
                     (handle, property, size, value, need))

NEARLIGHT_STATUS(clGetPlatformIDs, nullptr, (cl_uint size, cl_platform_id* list, cl_uint* count),
                 (size, list, count))
NEARLIGHT_STATUS(clGetDeviceIDs, nullptr,
                 (cl_platform_id platform, cl_device_type type, cl_uint size, cl_device_id* list,
                  cl_uint* count),
                 (platform, type, size, list, count))
NEARLIGHT_STATUS(clCreateSubDevices, device,
                 (cl_device_id device, const cl_device_partition_property* how, cl_uint size,
                  cl_device_id* list, cl_uint* count),
                 (device, how, size, list, count))
NEARLIGHT_INFO(clGetPlatformInfo, cl_platform_id, cl_platform_info)
NEARLIGHT_INFO(clGetDeviceInfo, cl_device_id, cl_device_info)
NEARLIGHT_INFO(clGetContextInfo, cl_context, cl_context_info)
NEARLIGHT_INFO(clGetProgramInfo, cl_program, cl_program_info)
NEARLIGHT_INFO(clGetEventInfo, cl_event, cl_event_info)
NEARLIGHT_INFO(clGetEventProfilingInfo, cl_event, cl_profiling_info)
NEARLIGHT_STATUS(clGetProgramBuildInfo, program,
                 (cl_program program, cl_device_id device, cl_program_build_info property, std::size_t size,
                  void* value, std::size_t* need),
                 (program, device, property, size, value, need))

NEARLIGHT_COUNTED(clRetainDevice, cl_device_id)
NEARLIGHT_COUNTED(clReleaseDevice, cl_device_id)
NEARLIGHT_COUNTED(clRetainContext, cl_context)
NEARLIGHT_COUNTED(clReleaseContext, cl_context)
NEARLIGHT_COUNTED(clRetainCommandQueue, cl_command_queue)
NEARLIGHT_COUNTED(clReleaseCommandQueue, cl_command_queue)
NEARLIGHT_COUNTED(clRetainMemObject, cl_mem)
NEARLIGHT_COUNTED(clReleaseMemObject, cl_mem)
NEARLIGHT_COUNTED(clRetainProgram, cl_program)
NEARLIGHT_COUNTED(clReleaseProgram, cl_program)
NEARLIGHT_COUNTED(clRetainKernel, cl_kernel)
NEARLIGHT_COUNTED(clReleaseKernel, cl_kernel)
NEARLIGHT_COUNTED(clRetainEvent, cl_event)
NEARLIGHT_COUNTED(clReleaseEvent, cl_event)

NEARLIGHT_HANDLE(cl_context, clCreateContext, devices[0],
                 (const cl_context_properties* properties, cl_uint count, const cl_device_id* devices,
                  void(CL_CALLBACK* notify)(const char*, const void*, std::size_t, void*), void* data,
                  cl_int* status),
                 (properties, count, devices, notify, data, status))
NEARLIGHT_HANDLE(cl_command_queue, clCreateCommandQueue, device,
                 (cl_context context, cl_device_id device, cl_command_queue_properties properties,
                  cl_int* status),
                 (context, device, properties, status))
NEARLIGHT_HANDLE(cl_mem, clCreateBuffer, context,
                 (cl_context context, cl_mem_flags flags, std::size_t size, void* data, cl_int* status),
                 (context, flags, size, data, status))
NEARLIGHT_HANDLE(cl_program, clCreateProgramWithSource, context,
                 (cl_context context, cl_uint count, const char** texts, const std::size_t* lengths,
                  cl_int* status),
                 (context, count, texts, lengths, status))
NEARLIGHT_HANDLE(cl_program, clCreateProgramWithBinary, context,
                 (cl_context context, cl_uint count, const cl_device_id* devices, const std::size_t* lengths,
                  const unsigned char** binaries, cl_int* binary_status, cl_int* status),
                 (context, count, devices, lengths, binaries, binary_status, status))
NEARLIGHT_HANDLE(cl_kernel, clCreateKernel, program, (cl_program program, const char* name, cl_int* status),
                 (program, name, status))

NEARLIGHT_STATUS(clBuildProgram, program,
                 (cl_program program, cl_uint count, const cl_device_id* devices, const char* options,
                  void(CL_CALLBACK* notify)(cl_program, void*), void* data),
                 (program, count, devices, options, notify, data))
NEARLIGHT_STATUS(clSetKernelArg, kernel,
                 (cl_kernel kernel, cl_uint index, std::size_t size, const void* value),
                 (kernel, index, size, value))
NEARLIGHT_STATUS(clSetMemObjectDestructorCallback, memory,
                 (cl_mem memory, void(CL_CALLBACK* notify)(cl_mem, void*), void* data),
                 (memory, notify, data))
NEARLIGHT_STATUS(clWaitForEvents, events[0], (cl_uint count, const cl_event* events), (count, events))
NEARLIGHT_STATUS(clFlush, queue, (cl_command_queue queue), (queue))
NEARLIGHT_STATUS(clFinish, queue, (cl_command_queue queue), (queue))
NEARLIGHT_STATUS(clEnqueueReadBuffer, queue,
                 (cl_command_queue queue, cl_mem buffer, cl_bool blocking, std::size_t offset,
                  std::size_t size, void* data, cl_uint count, const cl_event* events, cl_event* event),
                 (queue, buffer, blocking, offset, size, data, count, events, event))
NEARLIGHT_STATUS(clEnqueueWriteBuffer, queue,
                 (cl_command_queue queue, cl_mem buffer, cl_bool blocking, std::size_t offset,
                  std::size_t size, const void* data, cl_uint count, const cl_event* events, cl_event* event),
                 (queue, buffer, blocking, offset, size, data, count, events, event))

/// Gives a command that never runs the event of a marker.
static cl_int vanish(cl_command_queue queue, cl_event* event) {
    static auto* const driver = forwarded(clEnqueueMarkerWithWaitList, "clEnqueueMarkerWithWaitList");
    const cl_int status = driver(queue, 0, nullptr, event);
    if (event != nullptr) {
        faults().adopt(*event, queue);
    }
    return status;
}

NEARLIGHT_EXPORTED cl_int clEnqueueFillBuffer(cl_command_queue queue, cl_mem buffer, const void* pattern,
                                              std::size_t pattern_size, std::size_t offset, std::size_t size,
                                              cl_uint count, const cl_event* events, cl_event* event) {
    static auto* const driver = forwarded(clEnqueueFillBuffer, "clEnqueueFillBuffer");
    switch (faults().next("clEnqueueFillBuffer", queue)) {
        case Fate::runs:
            return driver(queue, buffer, pattern, pattern_size, offset, size, count, events, event);
        case Fate::vanishes:
            return vanish(queue, event);
        case Fate::fails:
            break;
    }
    return faults().code();
}

NEARLIGHT_EXPORTED cl_int clEnqueueNDRangeKernel(cl_command_queue queue, cl_kernel kernel, cl_uint dimensions,
                                                 const std::size_t* offset, const std::size_t* global,
                                                 const std::size_t* local, cl_uint count,
                                                 const cl_event* events, cl_event* event) {
    static auto* const driver = forwarded(clEnqueueNDRangeKernel, "clEnqueueNDRangeKernel");
    switch (faults().next("clEnqueueNDRangeKernel", queue)) {
        case Fate::runs: {
            const cl_int status =
                driver(queue, kernel, dimensions, offset, global, local, count, events, event);
            if (status == CL_SUCCESS && event != nullptr) {
                faults().adopt(*event, queue);
            }
            return status;
        }
        case Fate::vanishes:
            return vanish(queue, event);
        case Fate::fails:
            break;
    }
    return faults().code();
}
