#pragma once

/// Has the Python states and traces that ParaView writes load the plugin before the first of our sources. ParaView 5.11
/// leaves it out, so that its own pvpython cannot run them. Where Python does not run yet, once it does.
void sonoInstallPythonRecord();
