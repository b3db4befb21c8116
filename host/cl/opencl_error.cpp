// SPDX-License-Identifier: Apache-2.0
#include "host/cl/opencl_error.h"

namespace nearlight::core {

std::string opencl_error_name(cl_int code) {
    switch (code) {
#define NEARLIGHT_NAME(name) \
    case name:               \
        return #name
        NEARLIGHT_NAME(CL_SUCCESS);
        NEARLIGHT_NAME(CL_DEVICE_NOT_FOUND);
        NEARLIGHT_NAME(CL_DEVICE_NOT_AVAILABLE);
        NEARLIGHT_NAME(CL_COMPILER_NOT_AVAILABLE);
        NEARLIGHT_NAME(CL_MEM_OBJECT_ALLOCATION_FAILURE);
        NEARLIGHT_NAME(CL_OUT_OF_RESOURCES);
        NEARLIGHT_NAME(CL_OUT_OF_HOST_MEMORY);
        NEARLIGHT_NAME(CL_PROFILING_INFO_NOT_AVAILABLE);
        NEARLIGHT_NAME(CL_BUILD_PROGRAM_FAILURE);
        NEARLIGHT_NAME(CL_MAP_FAILURE);
        NEARLIGHT_NAME(CL_EXEC_STATUS_ERROR_FOR_EVENTS_IN_WAIT_LIST);
        NEARLIGHT_NAME(CL_COMPILE_PROGRAM_FAILURE);
        NEARLIGHT_NAME(CL_LINKER_NOT_AVAILABLE);
        NEARLIGHT_NAME(CL_LINK_PROGRAM_FAILURE);
        NEARLIGHT_NAME(CL_INVALID_VALUE);
        NEARLIGHT_NAME(CL_INVALID_DEVICE_TYPE);
        NEARLIGHT_NAME(CL_INVALID_PLATFORM);
        NEARLIGHT_NAME(CL_INVALID_DEVICE);
        NEARLIGHT_NAME(CL_INVALID_CONTEXT);
        NEARLIGHT_NAME(CL_INVALID_QUEUE_PROPERTIES);
        NEARLIGHT_NAME(CL_INVALID_COMMAND_QUEUE);
        NEARLIGHT_NAME(CL_INVALID_HOST_PTR);
        NEARLIGHT_NAME(CL_INVALID_MEM_OBJECT);
        NEARLIGHT_NAME(CL_INVALID_BINARY);
        NEARLIGHT_NAME(CL_INVALID_BUILD_OPTIONS);
        NEARLIGHT_NAME(CL_INVALID_PROGRAM);
        NEARLIGHT_NAME(CL_INVALID_PROGRAM_EXECUTABLE);
        NEARLIGHT_NAME(CL_INVALID_KERNEL_NAME);
        NEARLIGHT_NAME(CL_INVALID_KERNEL_DEFINITION);
        NEARLIGHT_NAME(CL_INVALID_KERNEL);
        NEARLIGHT_NAME(CL_INVALID_ARG_INDEX);
        NEARLIGHT_NAME(CL_INVALID_ARG_VALUE);
        NEARLIGHT_NAME(CL_INVALID_ARG_SIZE);
        NEARLIGHT_NAME(CL_INVALID_KERNEL_ARGS);
        NEARLIGHT_NAME(CL_INVALID_WORK_DIMENSION);
        NEARLIGHT_NAME(CL_INVALID_WORK_GROUP_SIZE);
        NEARLIGHT_NAME(CL_INVALID_WORK_ITEM_SIZE);
        NEARLIGHT_NAME(CL_INVALID_GLOBAL_OFFSET);
        NEARLIGHT_NAME(CL_INVALID_EVENT_WAIT_LIST);
        NEARLIGHT_NAME(CL_INVALID_EVENT);
        NEARLIGHT_NAME(CL_INVALID_OPERATION);
        NEARLIGHT_NAME(CL_INVALID_BUFFER_SIZE);
        NEARLIGHT_NAME(CL_INVALID_GLOBAL_WORK_SIZE);
        NEARLIGHT_NAME(CL_INVALID_PROPERTY);
        NEARLIGHT_NAME(CL_DEVICE_PARTITION_FAILED);
#undef NEARLIGHT_NAME
        case -1001:
            return "CL_PLATFORM_NOT_FOUND_KHR";
        default:
            return "error " + std::to_string(code);
    }
}

Error make_opencl_error(const cl::Error& error, const std::string& subject) {
    const bool memory = error.err() == CL_MEM_OBJECT_ALLOCATION_FAILURE ||
                        error.err() == CL_OUT_OF_HOST_MEMORY || error.err() == CL_INVALID_BUFFER_SIZE;
    const std::string message =
        std::string(error.what()) + " failed with " + opencl_error_name(error.err()) + " (" + subject + ")";
    if (memory) {
        return {ErrorKind::out_of_memory, message + "; free memory, or ask for less at a time"};
    }
    return {ErrorKind::failure, message + "; try again, or on another device", "device"};
}

}  // namespace nearlight::core
