#pragma once

class pqPipelineSource;
class pqTimeKeeper;

/// The time of the views of a source's server; none while that server is being left.
pqTimeKeeper* sonoTimeKeeperOf(const pqPipelineSource* source);

/// Which moment of an anatomy the views show, in the unit of its phases' times; 0 where there is none.
double sonoTimeOf(const pqPipelineSource* source);

/// Another moment from the next picture on, no step of undo. Does not draw.
void sonoSetTime(const pqPipelineSource* source, double time);

/// The moment that is shown is ParaView's time as well, in its animation controls; no step of undo.
void sonoKeepTime(const pqPipelineSource* source);
