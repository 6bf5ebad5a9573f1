#pragma once

class QToolBar;

/// Puts a menu "Ultrasound" into the main window's menu bar, before Help, so that what the tool bar and the scanner's
/// keys do can be reached by keys alone: Alt+U, arrows, Return. It shows what both have when it opens.
void sonoInstallMenu(QToolBar* bar);
