# Settings that every pmesh target shares.

find_package(Threads REQUIRED)
find_package(OpenSSL REQUIRED)
find_package(draco REQUIRED)
find_package(nlohmann_json REQUIRED)
find_package(spdlog REQUIRED)
find_package(CLI11 REQUIRED)
# Boost 1.81 or later; headers alone (Asio and Beast are compiled separately in server/).
find_package(Boost 1.81 REQUIRED)

add_library(pmesh_settings INTERFACE)
add_library(pmesh::settings ALIAS pmesh_settings)
set_target_properties(pmesh_settings PROPERTIES EXPORT_NAME settings)
target_compile_features(pmesh_settings INTERFACE cxx_std_20)
target_include_directories(pmesh_settings INTERFACE
  $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}> $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}/pmesh>)
# The order of collapses, and so the bytes of a file, depend on floating-point results: no
# contraction of a*b+c, on any compiler.
target_compile_options(pmesh_settings INTERFACE
  $<BUILD_INTERFACE:-ffp-contract=off;-Wall;-Wextra;-Wpedantic;-Wshadow;-Wconversion;-Wno-sign-conversion>
  $<BUILD_INTERFACE:$<$<BOOL:${PMESH_WERROR}>:-Werror>>)
if(PMESH_SANITIZE)
  target_compile_options(pmesh_settings INTERFACE
    $<BUILD_INTERFACE:-fsanitize=${PMESH_SANITIZE};-fno-omit-frame-pointer;-fno-sanitize-recover=all>)
  target_link_options(pmesh_settings INTERFACE $<BUILD_INTERFACE:-fsanitize=${PMESH_SANITIZE}>)
endif()
if(PMESH_BUILD_FUZZ)
  target_compile_options(pmesh_settings INTERFACE $<BUILD_INTERFACE:-fsanitize=fuzzer-no-link>)
endif()

# pmesh_add_library(NAME): a static library pmesh_NAME with the alias pmesh::NAME.
function(pmesh_add_library name)
  add_library(pmesh_${name} STATIC)
  add_library(pmesh::${name} ALIAS pmesh_${name})
  set_target_properties(pmesh_${name} PROPERTIES EXPORT_NAME ${name})
  target_link_libraries(pmesh_${name} PUBLIC pmesh_settings)
endfunction()
