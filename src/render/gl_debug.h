// What the driver complains about, for tests and for who works on the drawing: with CREASE_GL_DEBUG
// in the environment contexts are made for debugging, and every message above a notification is
// a line "OpenGL: ..." on standard error.
#pragma once

namespace crease {

bool wants_gl_debug();

// Of the OpenGL that is current on this thread, from now on; does nothing unless it is wanted.
void report_gl_messages();

}  // namespace crease
