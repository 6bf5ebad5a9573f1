#pragma once

/// Has the Python states and traces that ParaView writes load the plugin before the first of our sources, and keep how
/// its layout draws. ParaView 5.11 leaves both out. Where Python does not run yet, once it does.
void sonoInstallPythonRecord();
