"""Arrays in a GPU's memory, handed over by DLPack."""
import ctypes

from .vtkSonoFilters import vtkSonoGpuImage

_TENSOR = b"dltensor"  # a capsule's name until somebody has taken what it holds
_CUDA = 2

_new = ctypes.pythonapi.PyCapsule_New
_new.restype, _new.argtypes = ctypes.py_object, (ctypes.c_void_p, ctypes.c_char_p, ctypes.c_void_p)
_is_valid = ctypes.pythonapi.PyCapsule_IsValid
_is_valid.restype, _is_valid.argtypes = ctypes.c_int, (ctypes.c_void_p, ctypes.c_char_p)
_pointer = ctypes.pythonapi.PyCapsule_GetPointer
_pointer.restype, _pointer.argtypes = ctypes.c_void_p, (ctypes.c_void_p, ctypes.c_char_p)


def destructor(delete):
    """That of capsules whose tensors go by delete(address) where nobody has taken them. It has to outlive them."""
    def destroy(capsule):
        if _is_valid(capsule, _TENSOR):
            delete(_pointer(capsule, _TENSOR))

    return ctypes.CFUNCTYPE(None, ctypes.c_void_p)(destroy)


def capsule(address, destroy):
    """Of the DLManagedTensor at an address."""
    return _new(address, _TENSOR, ctypes.cast(destroy, ctypes.c_void_p))


_destroy = destructor(vtkSonoGpuImage.DeleteTensor)


class GpuArray:
    """An image of a data set, or its mask, in the memory of the GPU that made it: rows of uint8.

    torch.from_dlpack(array), or whoever else speaks DLPack, has it there without a copy. It is the same memory for all,
    so write into copies only.
    """

    dtype = "uint8"

    def __init__(self, image, name):
        self._image, self._name = image, name
        self.shape = (image.GetHeight(), image.GetWidth())

    def __dlpack_device__(self):
        return _CUDA, self._image.GetDevice()

    def __dlpack__(self, stream=None, **_):
        """The array is finished, so no stream has to wait for it; its memory goes back behind what the stream does."""
        return capsule(self._image.NewTensor(self._name, stream if stream and stream > 0 else 1), _destroy)
