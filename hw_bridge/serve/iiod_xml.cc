#include <pugixml.hpp>
#include <sstream>

#include "hw_bridge/serve/iiod_devices.h"

namespace twinbench::hw {
namespace {

constexpr const char* kDtd =
    "context ["
    "<!ELEMENT context (device | context-attribute)*>"
    "<!ELEMENT context-attribute EMPTY>"
    "<!ELEMENT device (channel | attribute | debug-attribute | buffer-attribute)*>"
    "<!ELEMENT channel (scan-element?, attribute*)>"
    "<!ELEMENT attribute EMPTY>"
    "<!ELEMENT scan-element EMPTY>"
    "<!ELEMENT debug-attribute EMPTY>"
    "<!ELEMENT buffer-attribute EMPTY>"
    "<!ATTLIST context name CDATA #REQUIRED version-major CDATA #REQUIRED version-minor CDATA #REQUIRED "
    "version-git CDATA #REQUIRED description CDATA #IMPLIED>"
    "<!ATTLIST context-attribute name CDATA #REQUIRED value CDATA #REQUIRED>"
    "<!ATTLIST device id CDATA #REQUIRED name CDATA #IMPLIED label CDATA #IMPLIED>"
    "<!ATTLIST channel id CDATA #REQUIRED type (input|output) #REQUIRED name CDATA #IMPLIED>"
    "<!ATTLIST scan-element index CDATA #REQUIRED format CDATA #REQUIRED scale CDATA #IMPLIED>"
    "<!ATTLIST attribute name CDATA #REQUIRED filename CDATA #IMPLIED>"
    "<!ATTLIST debug-attribute name CDATA #REQUIRED>"
    "<!ATTLIST buffer-attribute name CDATA #REQUIRED>"
    "]";

void Put(pugi::xml_node node, const char* name, const std::string& value) {
  if (!value.empty()) node.append_attribute(name).set_value(value.c_str());
}

void AddAttributes(pugi::xml_node parent, const char* tag, const IiodAttributes& attributes) {
  for (const IiodAttribute& attribute : attributes) {
    pugi::xml_node node = parent.append_child(tag);
    Put(node, "name", attribute.name);
    Put(node, "filename", attribute.filename);
  }
}

void AddChannel(pugi::xml_node device, const IiodChannel& channel) {
  pugi::xml_node node = device.append_child("channel");
  Put(node, "id", channel.id);
  Put(node, "name", channel.name);
  Put(node, "type", "input");
  if (channel.scan_index >= 0) {
    pugi::xml_node scan = node.append_child("scan-element");
    Put(scan, "index", std::to_string(channel.scan_index));
    Put(scan, "format", channel.format);
    for (const IiodAttribute& a : channel.attributes) {
      if (a.name == "scale") Put(scan, "scale", a.read());
    }
  }
  AddAttributes(node, "attribute", channel.attributes);
}

void AddDevice(pugi::xml_node context, const IiodDevice& device) {
  pugi::xml_node node = context.append_child("device");
  Put(node, "id", device.id);
  Put(node, "name", device.name);
  for (const IiodChannel& channel : device.channels) AddChannel(node, channel);
  AddAttributes(node, "attribute", device.attributes);
  AddAttributes(node, "debug-attribute", device.debug);
  AddAttributes(node, "buffer-attribute", device.buffer);
}

void AddContextAttribute(pugi::xml_node context, const std::string& name, const std::string& value) {
  pugi::xml_node node = context.append_child("context-attribute");
  Put(node, "name", name);
  Put(node, "value", value);
}

}  // namespace

std::string IiodXml(const std::vector<IiodDevice>& devices, const std::string& serial) {
  pugi::xml_document document;
  pugi::xml_node declaration = document.append_child(pugi::node_declaration);
  Put(declaration, "version", "1.0");
  Put(declaration, "encoding", "utf-8");
  document.append_child(pugi::node_doctype).set_value(kDtd);
  pugi::xml_node context = document.append_child("context");
  Put(context, "name", "network");
  Put(context, "version-major", "0");
  Put(context, "version-minor", "24");
  Put(context, "version-git", "v0.24");
  Put(context, "description", "twinbench rotary bench, simulated");
  AddContextAttribute(context, "hw_serial", serial);
  AddContextAttribute(context, "fw_version", TWINBENCH_VERSION);
  AddContextAttribute(context, "twinbench,simulated", "1");
  for (const IiodDevice& device : devices) AddDevice(context, device);
  std::ostringstream text;
  document.save(text, "", pugi::format_raw);
  return text.str();
}

}  // namespace twinbench::hw
