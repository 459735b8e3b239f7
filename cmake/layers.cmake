# The layers: a folder may include itself and the folders in its row, and the public headers that
# belong to those. The test `layers` reads every #include of the tree against these two tables.
set(CREASE_FOLDERS
  base parallel mesh hierarchy assemble io generate measure simplify codec pipeline
  stream http serve spill runtime render view)

set(CREASE_LAYER_base      )
set(CREASE_LAYER_parallel  base)
set(CREASE_LAYER_mesh      base)
set(CREASE_LAYER_hierarchy base mesh)
set(CREASE_LAYER_assemble  base mesh hierarchy)
set(CREASE_LAYER_io        base mesh)
set(CREASE_LAYER_generate  base mesh)
set(CREASE_LAYER_measure   base parallel mesh)
set(CREASE_LAYER_simplify  base parallel mesh hierarchy)
set(CREASE_LAYER_codec     base mesh hierarchy)
set(CREASE_LAYER_codec_encode base mesh hierarchy codec)  # the build's half of src/codec
set(CREASE_LAYER_pipeline  base parallel mesh hierarchy io simplify codec codec_encode)
set(CREASE_LAYER_stream    base codec)
set(CREASE_LAYER_http      base codec stream)
set(CREASE_LAYER_serve     base)
set(CREASE_LAYER_spill     base)
set(CREASE_LAYER_runtime   base mesh hierarchy assemble codec stream)
set(CREASE_LAYER_render    base mesh runtime)
set(CREASE_LAYER_view      base parallel mesh hierarchy assemble io codec codec_encode pipeline stream
                           http runtime render)

# Which folder a public header belongs to.
set(CREASE_HEADERS_base      vec.h ids.h result.h progress.h write_file.h)
set(CREASE_HEADERS_parallel  threads.h)
set(CREASE_HEADERS_mesh      mesh.h shading.h)
set(CREASE_HEADERS_hierarchy contraction.h progressive_arrays.h compact_ranges.h packed_indices.h
    parent_maps.h split_bounds.h stored_values.h mesh_hierarchy.h)
set(CREASE_HEADERS_assemble  build_progressive_arrays.h build_hierarchy.h)
set(CREASE_HEADERS_io        import.h import_arrays.h export.h)
set(CREASE_HEADERS_generate  generate.h)
set(CREASE_HEADERS_measure   compare.h)
set(CREASE_HEADERS_simplify  simplify.h)
set(CREASE_HEADERS_codec     file.h byte_source.h block_file.h decode_model.h)
set(CREASE_HEADERS_stream    async_source.h limited_source.h)
set(CREASE_HEADERS_http      http_source.h)
set(CREASE_HEADERS_serve     file_server.h)
set(CREASE_HEADERS_spill     memory_limit.h)
set(CREASE_HEADERS_pipeline  attribute_precision.h build.h)
set(CREASE_HEADERS_runtime   camera.h draw_list.h draw_changes.h indexed_arrays.h progressive_mesh.h
                           adaptive_mesh.h block_view.h block_mesh.h block_streamer.h)
set(CREASE_HEADERS_render    render.h)
set(CREASE_HEADERS_view      viewer.h)

# What goes into crease_runtime. These are compiled without exceptions and RTTI and need no library.
set(CREASE_RUNTIME_FOLDERS base mesh hierarchy assemble codec stream runtime)

# What fuzzers drive: instrumented for them where they are built. What only makes their models is not.
set(CREASE_FUZZED_FOLDERS base mesh hierarchy codec io stream http serve assemble runtime)

# Third-party headers that live in one place only: <prefix...> may be included by these folders.
set(CREASE_THIRD_PARTY embree3 epoxy EGL GL png.h turbojpeg.h lzma.h draco meshoptimizer.h tbb oneapi nlohmann CLI zstd.h
  curl microhttpd.h GLFW imgui.h backends)
set(CREASE_THIRD_PARTY_embree3  measure)
set(CREASE_THIRD_PARTY_epoxy    render)
set(CREASE_THIRD_PARTY_EGL      render)
set(CREASE_THIRD_PARTY_GL       render)
set(CREASE_THIRD_PARTY_png.h    render)
set(CREASE_THIRD_PARTY_turbojpeg.h render)
set(CREASE_THIRD_PARTY_lzma.h   io)
set(CREASE_THIRD_PARTY_zstd.h   io)
set(CREASE_THIRD_PARTY_draco    io)
set(CREASE_THIRD_PARTY_meshoptimizer.h io)
set(CREASE_THIRD_PARTY_tbb      parallel)
set(CREASE_THIRD_PARTY_oneapi   parallel)
set(CREASE_THIRD_PARTY_nlohmann io render serve view cli)
set(CREASE_THIRD_PARTY_CLI      cli)
set(CREASE_THIRD_PARTY_curl     http)
set(CREASE_THIRD_PARTY_microhttpd.h serve)
set(CREASE_THIRD_PARTY_GLFW     view)
set(CREASE_THIRD_PARTY_imgui.h  view)
set(CREASE_THIRD_PARTY_backends view)  # Dear ImGui's
