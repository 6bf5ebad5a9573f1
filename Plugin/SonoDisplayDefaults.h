#pragma once

/// Run once when the plugin is loaded, in any process. Where proxies are made (the client), it sees to a sensible first
/// display: grey for the images and nothing where they were not scanned, translucent surfaces in the labels' own
/// colours for an Ultrasound Scene, so that the picture inside the body can be seen, and a bold outline for an
/// Ultrasound Probe; and a sensible first pose of a new Simulate Ultrasound. What a person or a state file sets
/// afterwards stands.
void sonoInstallDisplayDefaults();
