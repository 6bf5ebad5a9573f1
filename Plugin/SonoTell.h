#pragma once

#include "vtkClientServerStream.h"
#include "vtkSMProxy.h"
#include "vtkSMSession.h"

/// Calls a method of the VTK objects of a proxy, wherever they are: for what nobody is to see in a panel, undo or find
/// in a state file, and what does not mean that anything has changed.
template<class... Values>
void sonoTell(vtkSMProxy* proxy, const char* method, Values... values)
{
  vtkClientServerStream stream;
  stream << vtkClientServerStream::Invoke << VTKOBJECT(proxy) << method;
  (stream << ... << values) << vtkClientServerStream::End;
  proxy->GetSession()->ExecuteStream(proxy->GetLocation(), stream);
}
