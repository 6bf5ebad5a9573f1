#include "vtkSonoServerStop.h"

#include "SonoInterruption.h"

#include "vtkAlgorithm.h"
#include "vtkClientSocket.h"
#include "vtkCommand.h"
#include "vtkCommunicator.h"
#include "vtkCompositeMultiProcessController.h"
#include "vtkNew.h"
#include "vtkObjectFactory.h"
#include "vtkPVProgressHandler.h"
#include "vtkPVSession.h"
#include "vtkProcessModule.h"
#include "vtkSocketCommunicator.h"
#include "vtkWeakPointer.h"

#include <algorithm>
#include <cstring>
#include <iterator>
#include <poll.h>
#include <set>
#include <sys/ioctl.h>
#include <sys/socket.h>
#include <vector>

vtkStandardNewMacro(vtkSonoServerStop);

namespace {

constexpr int stopTag = 532011; // of a remote call; ParaView's own have five digits
constexpr double progressS = 0.1;
/// What nobody sends by chance. In bytes, so that it is the same to any machine.
constexpr char words[] = "SonoVDB: stop what is running. 6f1c9a0e52d84b7f";

void readInTurn(void*, void*, int, int) {}

vtkSocketCommunicator* communicatorOf(vtkMultiProcessController* client)
{
  auto* communicator = client ? vtkSocketCommunicator::SafeDownCast(client->GetCommunicator()) : nullptr;
  return communicator && communicator->GetSocket() ? communicator : nullptr;
}

/// The connections to the clients of this server.
std::vector<vtkMultiProcessController*> clientsOf(vtkPVSession* session)
{
  vtkMultiProcessController* all = session->GetController(vtkPVSession::CLIENT);
  auto* several = vtkCompositeMultiProcessController::SafeDownCast(all);
  std::vector<vtkMultiProcessController*> clients;
  for (int i = 0; several && i < several->GetNumberOfControllers(); ++i)
  {
    clients.push_back(several->GetController(i));
  }
  if (!several && all)
  {
    clients.push_back(all);
  }
  return clients;
}

template<class Bytes>
bool holdsWords(const Bytes& bytes)
{
  return std::search(std::begin(bytes), std::end(bytes), std::begin(words), std::end(words)) != std::end(bytes);
}

/// Takes a wish out of the way of a server that waits for something else from its client.
class NotInTheWay : public vtkCommand
{
public:
  static NotInTheWay* New() { return new NotInTheWay; }
  void Execute(vtkObject*, unsigned long, void* message) override
  {
    int head[2]; // tag and length in bytes
    std::memcpy(head, message, sizeof(head));
    const auto* first = static_cast<const char*>(message) + sizeof(head);
    if (head[0] == vtkMultiProcessController::RMI_TAG && holdsWords(std::vector<char>(first, first + head[1])))
    {
      this->AbortFlagOn(); // dealt with
    }
  }
};

/// Whether there is a wish among what a client has sent and nobody has read, or nobody to read what is sent back.
bool asksForStop(vtkMultiProcessController* client)
{
  vtkSocketCommunicator* communicator = communicatorOf(client);
  if (!communicator)
  {
    return false;
  }
  pollfd arrived{ communicator->GetSocket()->GetSocketDescriptor(), POLLIN | POLLRDHUP, 0 };
  if (poll(&arrived, 1, 0) <= 0)
  {
    return false;
  }
  if (arrived.revents & (POLLRDHUP | POLLHUP | POLLERR))
  {
    return true;
  }
  int size = 0;
  if (ioctl(arrived.fd, FIONREAD, &size) != 0 || size < int(sizeof(words)))
  {
    return false;
  }
  std::vector<char> ahead(static_cast<std::size_t>(size));
  const ssize_t seen = recv(arrived.fd, ahead.data(), ahead.size(), MSG_PEEK | MSG_DONTWAIT);
  ahead.resize(static_cast<std::size_t>(std::max<ssize_t>(seen, 0)));
  return holdsWords(ahead);
}

/// Of a server process, as long as it runs.
class Listener : public sono::Interrupter
{
public:
  explicit Listener(vtkPVSession* session)
    : Session(session)
  {
    session->GetProgressHandler()->SetProgressInterval(progressS);
  }

  bool wantsStop() override
  {
    const auto clients = this->clients();
    return std::any_of(clients.begin(), clients.end(), asksForStop);
  }

  void hasStopped(vtkAlgorithm* filter) override { this->Stopped.insert(filter); }
  void hasFinished(vtkAlgorithm* filter) override { this->Stopped.erase(filter); }
  bool waits(vtkAlgorithm* filter) const { return this->Stopped.count(filter) > 0; }

  /// Expects a wish from all clients that there are by now.
  void greet()
  {
    for (vtkMultiProcessController* client : this->clients())
    {
      vtkCommunicator* communicator = client->GetCommunicator();
      if (communicator && !communicator->HasObserver(vtkCommand::WrongTagEvent, this->OutOfTheWay))
      {
        constexpr float beforeParaView = 1000.0F;
        client->AddRMICallback(readInTurn, nullptr, stopTag);
        communicator->AddObserver(vtkCommand::WrongTagEvent, this->OutOfTheWay, beforeParaView);
      }
    }
  }

private:
  std::vector<vtkMultiProcessController*> clients() const
  {
    return this->Session ? clientsOf(this->Session) : std::vector<vtkMultiProcessController*>();
  }

  vtkWeakPointer<vtkPVSession> Session;
  vtkNew<NotInTheWay> OutOfTheWay;
  std::set<vtkAlgorithm*> Stopped; // compared, never used: they may be gone
};

Listener* listener = nullptr;

} // namespace

vtkSonoServerStop::vtkSonoServerStop() = default;
vtkSonoServerStop::~vtkSonoServerStop() = default;

void vtkSonoServerStop::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "Listens: " << (listener ? "yes" : "no") << endl;
}

void vtkSonoServerStop::Listen()
{
  const int process = vtkProcessModule::GetProcessType();
  auto* session = vtkPVSession::SafeDownCast(vtkProcessModule::GetProcessModule()->GetSession());
  if (!session || (process != vtkProcessModule::PROCESS_SERVER && process != vtkProcessModule::PROCESS_DATA_SERVER))
  {
    return;
  }
  if (!listener)
  {
    static Listener all(session);
    listener = &all;
    sono::setInterrupter(listener);
  }
  listener->greet();
}

bool vtkSonoServerStop::Waits(vtkAlgorithm* filter)
{
  return listener && listener->waits(filter);
}

void vtkSonoServerStop::Ask(vtkPVSession* session)
{
  vtkMultiProcessController* server = session->GetController(vtkPVSession::DATA_SERVER_ROOT);
  if (communicatorOf(server))
  {
    char message[sizeof(words)];
    std::copy(std::begin(words), std::end(words), message);
    server->TriggerRMI(1, message, sizeof(message), stopTag);
  }
}
