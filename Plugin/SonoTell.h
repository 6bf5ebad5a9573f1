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

/// The same for a method that gives an answer, which the client waits for; Answer() where there is none.
template<class Answer, class... Values>
Answer sonoAsk(vtkSMProxy* proxy, const char* method, Values... values)
{
  sonoTell(proxy, method, values...);
  Answer answer{};
  proxy->GetSession()->GetLastResult(proxy->GetLocation()).GetArgument(0, 0, &answer);
  return answer;
}
